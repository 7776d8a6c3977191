// Choices that hold for all runs: colours, units, time base.

const kKey = 'hydro-scope.preferences';
const kDefault = { theme: 'auto', si: false, span: 10 };

export function loadPreferences(storage) {
  try {
    const kept = JSON.parse(storage.getItem(kKey) ?? '{}') ?? {};
    return {
      theme: ['auto', 'light', 'dark'].includes(kept.theme) ? kept.theme : kDefault.theme,
      si: kept.si === true,
      span: kept.span >= 1e-3 && kept.span <= 36000 ? kept.span : kDefault.span,
    };
  } catch {
    return { ...kDefault };
  }
}

export function savePreferences(storage, preferences) {
  const { theme, si, span } = preferences;
  storage.setItem(kKey, JSON.stringify({ theme, si, span }));
}
