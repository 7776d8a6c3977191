// Builds elements. Text is always text: nothing that comes from a log or the network is ever read as markup.

// el('button', {class: 'icon', text: 'Fit', onclick: f, 'aria-label': 'Fit'}, ...children)
export function el(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === 'text') element.textContent = value;
    else if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'class') element.className = value;
    else if (name === 'value' || name === 'checked' || name === 'selected') element[name] = value;
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

export function byId(id) {
  const element = document.getElementById(id);
  if (!element) throw new Error(`no element #${id} in the page`);
  return element;
}

// Sets the text only when it differs, so that a screen reader and the layout are left in peace.
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// A labelled field: el('label', ..., 'Level', input, 'psi').
export function field(label, input, unit = '') {
  return el(
    'label',
    { class: 'field' },
    el('span', { class: 'name', text: label }),
    input,
    unit instanceof Node ? unit : el('span', { class: 'unit', text: unit }),
  );
}

export function choice(options, value, onchange, properties = {}) {
  return el(
    'select',
    { ...properties, onchange: (event) => onchange(event.target.value) },
    ...options.map(([name, text]) => el('option', { value: name, text, selected: name === value })),
  );
}

// Offers bytes or text to the user as a file.
export function offerFile(name, blob) {
  const address = URL.createObjectURL(blob);
  const link = el('a', { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

// A drawn sign in the colour of the text: fonts do not agree on the signs of a tape recorder.
export function icon(path) {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '0 0 16 16');
  svg.setAttribute('aria-hidden', 'true');
  svg.classList.add('icon');
  const shape = document.createElementNS(space, 'path');
  shape.setAttribute('d', path);
  svg.append(shape);
  return svg;
}
