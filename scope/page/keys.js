// The keyboard: every action of the page has a key, and the help lists them from this one table.

export function keyTable(actions) {
  return [
    {
      keys: ['s', 'F9'],
      name: 'S, or F9 even in a text field',
      what: 'STOP: zero volts, now',
      act: actions.stop,
      anywhere: ['F9'],
    },
    { keys: [' '], name: 'Space', what: 'pause, or follow the newest again; play or pause a log', act: actions.toggle },
    { keys: ['f'], name: 'F', what: 'fit: the whole run or capture', act: actions.fit },
    { keys: ['l'], name: 'L', what: 'follow the newest (live)', act: actions.follow },
    { keys: ['+', '='], name: '+', what: 'zoom in: a shorter time base', act: () => actions.step(-1) },
    { keys: ['-'], name: '−', what: 'zoom out: a longer time base', act: () => actions.step(1) },
    {
      keys: ['ArrowLeft', 'ArrowRight'],
      name: '← →',
      what: 'pan by a tenth; Shift: move the active cursor; Alt: one sample',
      act: actions.arrow,
    },
    { keys: ['Home', 'End'], name: 'Home, End', what: 'to the start, to the end of the run', act: actions.ends },
    { keys: ['c'], name: 'C', what: 'cursors on or off', act: actions.cursors },
    { keys: ['a', 'b'], name: 'A, B', what: 'put the cursor at the pointer, or choose it', act: actions.cursor },
    { keys: ['m'], name: 'M', what: 'mark an event now', act: actions.mark },
    { keys: ['t'], name: 'T', what: 'trigger on or off', act: actions.trigger },
    { keys: ['1'], name: '1', what: 'arm a single trigger again', act: actions.arm },
    { keys: ['[', ']'], name: '[ ]', what: 'the trigger level down, up', act: actions.level },
    { keys: ['g'], name: 'G', what: 'ghost on or off', act: actions.ghost },
    { keys: [',', '.'], name: ', .', what: 'a log: one sample back, on', act: actions.sample },
    { keys: ['v'], name: 'V', what: 'say the values, for a screen reader', act: actions.say },
    { keys: ['u'], name: 'U', what: 'the units of the model, or SI', act: actions.units },
    { keys: ['d'], name: 'D', what: 'light, dark or as the system', act: actions.theme },
    { keys: ['?', 'h'], name: '?', what: 'this help', act: actions.help },
  ];
}

// Listens for the table's keys. Keys typed into a field are the field's, but for those that work anywhere.
export function listen(table, root = document) {
  root.addEventListener(
    'keydown',
    (event) => {
      if (event.ctrlKey || event.metaKey) return;
      const entry = table.find(({ keys }) =>
        keys.includes(event.key.length === 1 ? event.key.toLowerCase() : event.key),
      );
      if (!entry) return;
      if (isTyping(event.target, event.key) && !entry.anywhere?.includes(event.key)) return;
      event.preventDefault();
      entry.act(event.key, event);
    },
    true,
  );
}

function isTyping(target, key) {
  if (!(target instanceof HTMLElement)) return false;
  // Letters mean nothing in a field of numbers, but for the exponent's.
  if (target.matches('input[type=number]') && /^[a-df-z?]$/i.test(key)) return false;
  if (target.matches('textarea, select, [contenteditable]')) return true;
  if (target.matches('input'))
    return (
      !['checkbox', 'radio', 'button', 'range'].includes(target.type) ||
      key.startsWith('Arrow') ||
      key === ' ' ||
      key === 'Home' ||
      key === 'End'
    );
  return key === ' ' && target.matches('button, summary, a');
}
