// The token that hydro-scope prints: taken from the address, kept for this tab only, and out of sight.

const kKey = 'hydro-scope.token';

// The token in "#token=...", a whole address or a bare token; '' when there is none.
export function tokenIn(text) {
  const found = /(?:^|[#&?])token=([0-9A-Za-z_-]+)/.exec(text) ?? /^\s*([0-9A-Za-z_-]{8,})\s*$/.exec(text);
  return found ? found[1] : '';
}

// Takes the token out of the address bar, so that it is not in screenshots, bookmarks or the history.
export function takeToken(place, past, storage) {
  const fresh = place.hash.includes('token=') ? tokenIn(place.hash) : '';
  if (fresh) {
    storage.setItem(kKey, fresh);
    past.replaceState(null, '', place.pathname + place.search);
  }
  return fresh || storage.getItem(kKey) || '';
}

export function keepToken(token, storage) {
  storage.setItem(kKey, token);
}
