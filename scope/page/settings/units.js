// Values in the units of the stack (inch, pound-force, psi) or in SI: the factors come with the channels.

const kSigns = { us: 'µs', sigma: 'σ' };

export function unitOf(channel, si) {
  const unit = si && channel.si ? channel.si.unit : channel.unit;
  return kSigns[unit] ?? unit;
}

export function factorOf(channel, si) {
  return si && channel.si ? channel.si.factor : 1;
}
