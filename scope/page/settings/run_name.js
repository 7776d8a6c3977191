// A run's name without the folders before it.

export function baseName(name) {
  return name.split(/[\\/]/).at(-1) || name;
}
