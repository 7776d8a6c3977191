// Values in the units of the stack's model or in SI: the factors come with the channels.

const kSigns = { us: 'µs', sigma: 'σ' };

export function unitOf(channel, si) {
  const unit = si && channel.si ? channel.si.unit : channel.unit;
  return kSigns[unit] ?? unit;
}

// "in · psi", "m · Pa": what the run's values are in, on a button.
export function modelUnits(run) {
  const [length, , , pressure] = (run?.units ?? 'in, lbf, s, psi, rad').split(', ');
  return `${length} · ${pressure}`;
}

export function factorOf(channel, si) {
  return si && channel.si ? channel.si.factor : 1;
}
