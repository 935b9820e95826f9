'use strict';
// The search of the gallery: the robots of the page's data that have all words, the format and the verdict.
(() => {
  const STEP = 48;
  const all = JSON.parse(document.getElementById('data').textContent);
  const $ = id => document.getElementById(id);
  const fields = { words: 'value', format: 'value', kind: 'value', order: 'value', still: 'checked' };
  all.forEach(one => { one.text = `${one.name} ${one.robot} ${one.package} ${one.file}`.toLowerCase(); });
  let found = [], shown = 0;

  const make = (tag, attributes, ...children) => {
    const element = Object.assign(document.createElement(tag), attributes);
    element.append(...children);
    return element;
  };
  // Two numbers, or one dash where both are missing.
  const pair = ([a, b]) => a === null && b === null ? '–' : `${number(a)}, ${number(b)}`;
  const number = value => value === null || value === undefined ? '–' : String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, '\u2009');

  // A text with its parts in backquotes as code.
  const coded = text => text.split('`').map((part, k) => k % 2 ? make('code', { textContent: part }) : part);

  function card(one) {
    const link = `${one.page}.html`;
    const face = one.picture
      ? make('img', { src: `pictures/${one.page}.svg`, alt: one.name, loading: 'lazy', width: 320, height: 240 })
      : make('span', { className: 'none', textContent: one.nv ? 'no picture' : one.nv === 0 ? 'no freedoms' : 'not read' });
    const facts = [
      ['freedoms', number(one.nv)], ['links', number(one.links)],
      ['operations', pair(one.operations), 'of inverse and of forward dynamics'], ['ns', pair(one.ns), 'of one call of inverse and of forward dynamics'],
    ];
    const rows = facts.map(([name, value, title = '']) => make('span', { title }, make('b', { textContent: value }), ` ${name}`));
    const rest = one.verdict.startsWith(one.kind) ? one.verdict.slice(one.kind.length) : `: ${one.verdict}`;
    const notes = [make('p', {}, make('strong', { className: one.kind.replace(' ', '-'), textContent: one.kind }), ...coded(rest))];
    if (one.steps) notes.push(make('p', {}, `steps with constraints: ${one.steps}`));
    if (one.warnings) notes.push(make('p', {}, make('a', { href: link, textContent: one.warnings === 1 ? '1 warning' : `${one.warnings} warnings` })));
    return make('article', { className: 'card' },
      make('a', { href: link, className: 'face' }, face),
      make('h2', {}, make('a', { href: link, textContent: one.name })),
      make('p', { className: 'from' }, `${one.format} · ${one.package}`, make('br', {}), make('code', { textContent: one.file })),
      make('p', { className: 'numbers' }, ...rows),
      make('div', { className: 'verdict' }, ...notes));
  }

  function more() {
    $('robots').append(...found.slice(shown, shown + STEP).map(card));
    shown = Math.min(found.length, shown + STEP);
    $('more').hidden = shown >= found.length;
  }

  function search() {
    const words = $('words').value.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = one => words.every(word => one.text.includes(word)) && (!$('format').value || one.format === $('format').value)
      && (!$('kind').value || one.kind === $('kind').value);
    const alike = all.filter(fits);
    // A file that is not read has no number of freedoms; it is shown, since a user looks for its reason.
    found = alike.filter(one => $('still').checked || one.nv !== 0);
    const order = $('order').value, size = one => (order === 'nv' ? one.nv : one.operations[0]) ?? -1;
    // Names that are or begin with the words come first.
    const whole = words.join('_'), rank = one => {
      const name = one.name.toLowerCase();
      return name === whole ? 0 : name.startsWith(words[0]) ? 1 : name.includes(words[0]) ? 2 : 3;
    };
    if (order === 'name' && words.length) found.sort((a, b) => rank(a) - rank(b));
    if (order !== 'name') found.sort((a, b) => size(b) - size(a));
    const hidden = alike.length - found.length;
    $('count').textContent = `${found.length} of ${all.length} files` + (hidden ? `, and ${hidden} without freedoms` : '')
      + (alike.length ? '' : '. `articulated check FILE` says whether a file of yours is read.'.replaceAll('`', ''));
    $('robots').replaceChildren();
    shown = 0;
    more();
    // The address keeps the search, so that it can be sent.
    const kept = new URLSearchParams();
    for (const [id, key] of Object.entries(fields)) if ($(id)[key] && $(id)[key] !== 'name') kept.set(id, $(id)[key]);
    history.replaceState(null, '', kept.size ? `#${kept}` : location.pathname + location.search);
  }

  for (const [id, value] of new URLSearchParams(location.hash.slice(1))) {
    if (id in fields) $(id)[fields[id]] = fields[id] === 'checked' ? value === 'true' : value;
  }
  $('search').addEventListener('input', search);
  $('search').addEventListener('submit', event => event.preventDefault());
  $('more').addEventListener('click', more);
  search();
})();
