// What the trigger waits for. The server evaluates it on every sample; here are the settings, their limits,
// and the message that carries them. Levels are in the stack's units, whatever units are shown.

export const kModes = ['auto', 'normal', 'single'];
export const kEdges = ['rising', 'falling', 'either'];
export const kCauses = ['level', 'fault', 'step'];

export function defaultTrigger() {
  return {
    on: 'level',
    channel: 'dp',
    level: 0,
    edge: 'rising',
    hysteresis: 0,
    holdoff: 0.1,
    pre: 0.25,
    mode: 'normal',
    span: 0.5,
  };
}

const kLimits = { hysteresis: [0, Infinity], holdoff: [0, 3600], pre: [0, 1], span: [1e-3, 60] };

const kNames = { hysteresis: 'hysteresis', holdoff: 'hold-off', pre: 'pre-trigger', span: 'length', level: 'level' };

// '' when the settings can be sent, else what is wrong, what is allowed.
export function triggerError(settings) {
  for (const [name, [low, high]] of Object.entries(kLimits)) {
    const value = settings[name];
    if (!(value >= low && value <= high)) {
      const range = high === Infinity ? `at least ${low}` : `from ${low} to ${high}`;
      return `${kNames[name]} is ${value}: give a number ${range}`;
    }
  }
  if (settings.on === 'level' && !Number.isFinite(settings.level)) return 'level: give a number';
  return '';
}

export function triggerMessage(settings, id, run, channels, pixels) {
  const { on, channel, level, edge, hysteresis, holdoff, pre, mode, span } = settings;
  return { op: 'trigger', id, run, channels, channel, level, edge, hysteresis, holdoff, pre, mode, on, span, pixels };
}

// The hysteresis offered with a channel: a fiftieth of what is seen, so that noise does not trigger.
export function offeredHysteresis(low, high) {
  const spread = high - low;
  return spread > 0 ? Number((spread / 50).toPrecision(1)) : 0;
}
