// document.js - shows the lines of document.c as elements beside the canvas.  Only
// what has changed is written: layout is the dearest part of a frame, and a
// selection, a translation or a half typed number elsewhere stays.

const LIVE = 100; // ms between two texts of a run that goes on
const SPOKEN = 4000; // ms between two texts that a screen reader speaks
let now = {}; // lines of the last frame: word -> list of lines, each a list of fields
let lists = {}; // lines of pages, scenes and keys
const seen = {}; // lines that are shown, by their words
let [rendered, spoken] = [-1e9, -1e9]; // ms, times of the last text and spoken text
let late = 0; // timer of the next text
let sheet = null; // {canvas}: where Page.show draws while the lecture is printed

const parseLines = (text) => {
  const lines = {};
  for (const line of text.split('\n')) {
    const [word, ...fields] = line.split('\t');
    if (word) (lines[word] ??= []).push(fields);
  }
  return lines;
};
const field = (word, i = 0) => now[word]?.[0][i] ?? '';
const obey = (line) => wake(ask('web_obey_script', null, line));

// Keeps a value in `store` and returns whether it differs from the value before.
const isNew = (store, key, value) => store[key] !== (store[key] = JSON.stringify(value));
// Writes a property that has changed.
const put = (element, key, value) => element[key] === value || (element[key] = value);
// Shows lines as the children of an element.  show(line, index, child) returns the
// child of a line that has changed: the old one or a new one.
const fill = (parent, lines, show) => {
  lines.forEach((line, i) => {
    const old = parent.children[i];
    if (old && !isNew(old, 'line', line)) return;
    const child = show(line, i, old);
    if (child === old) return;
    isNew(child, 'line', line);
    old ? old.replaceWith(child) : parent.append(child);
  });
  while (parent.children.length > lines.length) parent.lastChild.remove();
};

// ---- texts ------------------------------------------------------------------

const plain = (text) =>
  text.replace(SLIDES, (all, name) => LETTERS[name]).replace(/#[\w-]+\*?(?=\{)|[{}_]/g, '');

// Makes a link of the number of a page, and buttons of keys: "Press R, P, N", "or Space".
const LINKS =
  /([Pp]age[ \u00a0]\d+|(?<=[Pp]ress (?:[A-Z]\w*,?(?: and| then)? )*|[Kk]ey |then |or )(?:Space|[A-Z])\b)/;
const addLinks = (element) => {
  const makeLink = (text) => {
    const page = lists.pages[text.slice(5) - 1];
    if (page) return make('a', [text], { href: '#' + page[0] });
    const button = make('button', [text], { class: 'key' });
    return Object.assign(button, { onclick: () => key(text) });
  };
  for (const node of [...element.childNodes].filter((child) => child.nodeType === Node.TEXT_NODE))
    node.replaceWith(...node.data.split(LINKS).map((text, i) => (i % 2 ? makeLink(text) : text)));
};

const paragraph = ([colour, bold, text], asFormula) => {
  const p = make('p', [], asFormula ? { class: 'formula' } : {});
  addLinks(setMarkup(p, text, asFormula));
  if (colour !== '#1c1c1c') p.style.color = colour;
  if (bold === '1') p.style.fontWeight = 'bold';
  return p;
};

// ---- numbers ----------------------------------------------------------------

const makeInput = (ariaLabel, onchange, more) =>
  Object.assign(make('input'), { ariaLabel, onchange, inputMode: 'decimal', ...more });

// Makes a slider from a tenth to ten times the first value, or as far as the number
// that Try names after the label: "h to 0.01", "k to 10^{9}", "k to 2·10^{5}".
const makeSlider = (name, label, first) => {
  const text = (now.try ?? []).map((line) => line[2]).join(' ');
  const after = text.slice(text.indexOf(label));
  const [, factor = 1, base = first, power = 1] =
    / to (?:([\d.]+)·)?(\d+(?:\.\d+)?)(?:\^\{(\d+)\})?/.exec(after) ?? [];
  const most = Math.max(Math.log(10), Math.abs(Math.log((factor * base ** power) / first)));
  const range = { type: 'range', min: -most, max: most, step: most / 100, value: 0, first };
  range.oninput = ({ target }) => {
    const number = Number((first * Math.exp(target.value)).toPrecision(3));
    obey(`set ${name} ${name === 'segments' ? Math.round(number) || 1 : number}`);
  };
  return makeInput(name, null, range);
};

const makeNumber = ([name, label, value, unit, choices, , , shown]) => {
  const words = setMarkup(make('span'), label);
  const full = label === name ? name : `${words.textContent}, ${name}`;
  const change = ({ target }) => obey(`set ${name} ${target.value}`);
  const options = choices.split('|').map((choice) => new Option(choice));
  const element = choices ? make('select', options) : makeInput();
  Object.assign(element, { name, ariaLabel: full, onchange: change });
  const item = make('label', [words, element, setMarkup(make('span'), unit)]);
  if (shown === 'tried') item.append(makeSlider(name, label, Number(value) || 1));
  return item;
};

const makePoint = ([index, x, y]) => {
  const send = () => obey(`handle ${index} ${fields[0].value} ${fields[1].value}`);
  const fields = [x, y].map((value, i) => makeInput(`point ${index}, ${'xy'[i]}`, send, { value }));
  return make('label', ['point', ...fields, 'm']);
};
const makeSwitch = ([index, on, label]) => {
  const box = { type: 'checkbox', checked: on === '1' };
  const flip = () => obey(`flip ${index}`);
  return make('label', [makeInput(plain(label), flip, box), setMarkup(make('span'), label)]);
};

const showNumbers = () => {
  const rows = now.number ?? [];
  if (isNew(seen, 'names', [now.page, rows.map((row) => row[0] + row[7])]))
    for (const id of ['tried', 'row', 'others'])
      $(id).replaceChildren(...rows.filter((row) => row[7] === id).map(makeNumber));
  const exhibit = [...(now.switch ?? []), ...(now.point ?? [])];
  const show = (line) => (now.point?.includes(line) ? makePoint : makeSwitch)(line);
  if (!$('exhibit').contains(document.activeElement)) fill($('exhibit'), exhibit, show);
  for (const [name, , value, , , help, idle] of rows) {
    const element = document.querySelector(`[name="${name}"]`);
    const slider = element.parentNode.querySelector('[type=range]');
    put(element.parentNode, 'title', idle || help);
    put(element, 'disabled', Boolean(idle));
    if (document.activeElement !== element) put(element, 'value', value);
    if (element.options) put(element.parentNode, 'hidden', !element.value); // panes differ
    if (!slider || document.activeElement === slider || !isNew(slider, 'shown', value)) continue;
    slider.setAttribute('aria-valuetext', value);
    slider.value = Math.max(-99, Math.log(value / slider.first));
  }
};

// ---- cards ------------------------------------------------------------------

const isDrawn = (kind) => kind === 'graph' || kind === 'star';

// Shows a line of an algorithm, with its values at the right.
const showRow = ([, lit, struck, indented, text, value], i, old) => {
  const line = old ?? make('tr', [make('td', [String(i + 1)]), make('td'), make('td')]);
  setMarkup(line.children[1], text).classList.toggle('indented', indented === '1');
  setMarkup(line.children[2], value);
  line.ariaCurrent = lit === '1' ? 'step' : null;
  line.classList.toggle('struck', struck === '1');
  return line;
};

// A row of a table; the first row and the first column are heads.
const makeCells = ([, colour, ...texts], i) => {
  const isHead = (text, at) => text && (i === 0 || at === 0);
  const cells = texts.map((text, at) => setMarkup(make(isHead(text, at) ? 'th' : 'td'), text));
  cells[0].style.color = colour;
  return make('tr', cells);
};

// Shows a row of a legend: a name, and its value.
const showEntry = ([, colour, name, value = ''], i, old) => {
  const entry = old ?? make('li', [make('span'), ' ', make('span')]);
  setMarkup(entry.firstChild, name);
  setMarkup(entry.lastChild, value);
  entry.style.color = colour;
  return entry;
};

// Lists of a card by their class: the element, and how a line is shown.
const showWords = ([, ...line]) => paragraph(line, true);
const LISTS = {
  words: ['div', showWords],
  row: ['table', showRow],
  cells: ['table', makeCells],
  legend: ['ul', showEntry],
};
const group = (name, ...children) => make('div', children, { class: name });
const makeLists = (...words) =>
  words.map((word) =>
    make(LISTS[word][0], [], { class: word, tabindex: word === 'cells' ? 0 : -1 }),
  );
const makeBody = (canvas) =>
  canvas
    ? group('figure', ...makeLists('legend'), group('paper', canvas))
    : group('lines', ...makeLists('words', 'row', 'cells'));
const showBody = (body, index, lines = now) => {
  const isOf = ([of]) => of === index;
  for (const list of body.children)
    if (LISTS[list.className])
      fill(list, (lines[list.className] ?? []).filter(isOf), LISTS[list.className][1]);
  return body;
};

const makeCard = ([index, name, kind, closed, , description]) => {
  const how = { role: 'img', id: 'graph' + index, 'aria-label': plain(description) };
  const body = makeBody(isDrawn(kind) && make('canvas', [], how));
  const card = make('details', [make('summary'), body], { class: kind, id: 'card-' + name });
  card.open = closed === '0';
  card.ontoggle = () => tell(REDRAW, { clientX: 0, clientY: 0 });
  if (!isDrawn(kind)) return card;
  const larger = make('button', ['⤢'], { 'aria-label': 'Larger, or as before' });
  larger.onclick = () => card.ontoggle(card.classList.toggle('large'));
  body.append(larger);
  return card;
};

const showCards = () => {
  const all = now.card ?? [];
  if (isNew(seen, 'cards', [field('page', 2), all.map((card) => card.slice(0, 4))])) {
    const made = all.map(makeCard);
    $('graphs').replaceChildren(...made.filter((card) => isDrawn(card.className)));
    $('cards').replaceChildren(...made.filter((card) => !isDrawn(card.className)));
  }
  for (const [index, name, , , title] of all) {
    setMarkup($('card-' + name).firstChild, title);
    showBody($('card-' + name).lastChild, index);
  }
};

// Draws the graphs.  Their sizes are read after all texts have changed, so that the
// page is laid out once.
const drawCards = () => {
  for (const { id, parentNode: box } of document.querySelectorAll('#graphs canvas'))
    if (box.clientWidth && box.clientHeight)
      Module._web_draw_card(Number(id.slice(5)), pixels(box.clientWidth), pixels(box.clientHeight));
};

// ---- all of it --------------------------------------------------------------

const openPart = (id) => {
  $(id).open = !$(id).open;
  if ($(id).open) $(id).firstElementChild.focus(); // which scrolls there
};

const showPage = ([[number, of, name]]) => {
  const inLecture = number !== '0';
  $('place').textContent = inLecture ? `Page ${number} of ${of}` : 'A scene';
  $('before').disabled = number === '1';
  $('after').disabled = number === of;
  for (const link of document.querySelectorAll('footer li a'))
    link.ariaCurrent = link.hash === `#${inLecture ? '--lecture+' : ''}${name}` ? 'page' : null;
  $('all').onclick = () => openPart(inLecture ? 'pages' : 'scenes');
  $('pages').open = $('scenes').open = false;
  spoken = -1e9;
  $('answer').value = $('answer2').value = '';
  scrollTo(0, 0);
  updateAddress();
};

const showGuess = ([[kind, coordinates] = []]) => {
  const had = $('guess').contains(document.activeElement);
  $('guess').hidden = !kind;
  $('typed').hidden = kind === 'words';
  $('second').hidden = kind !== 'place' || coordinates === '1';
  $('how').textContent = kind === 'place' ? 'Click in the picture, or x' : 'Your answer';
  if (kind) return;
  if (had) $('look').focus({ preventScroll: true }); // the form is hidden
  $('look').scrollIntoView({ block: 'nearest' });
};

// Called after a frame.  Texts of a run that goes on change every LIVE ms.
const showDocument = (time) => {
  drawn = false;
  if (bare || canvas.hidden) return;
  clearTimeout(late);
  if (field('step', 2) === '0' && time - rendered < LIVE) {
    late = setTimeout(() => showDocument(performance.now()), LIVE); // no frame may follow
    return drawCards();
  }
  rendered = time;
  now = parseLines(ask('web_get_document', 'string'));
  const number = Number(field('page'));
  const [warning, told] = now.told[0];
  const [step, newest, stands] = now.step[0];
  if (isNew(seen, 'page', now.page)) showPage(now.page);
  for (const id of ['topic', 'sentence', 'verdict', 'time']) setMarkup($(id), field(id));
  put(document, 'title', `${number ? number + '. ' : ''}${$('topic').textContent} · elasto`);
  for (const word of ['text', 'formula', 'ask', 'look', 'try', 'claim', 'notes']) {
    put($(word), 'hidden', !now[word]);
    fill($(word), now[word] ?? [], (line) => paragraph(line, word === 'formula'));
  }
  setMarkup($('told'), told === field('verdict') ? '' : told);
  put($('told'), 'className', warning === '1' ? 'warning' : '');
  if (isNew(seen, 'asks', [now.asks, now.page, !now.look])) showGuess(now.asks ?? []);
  put($('step'), 'max', newest);
  if (document.activeElement !== $('step')) put($('step'), 'value', step);
  put($('play').firstElementChild, 'textContent', stands === '1' ? '▶' : '❚❚');
  const showCode = ([lit, text]) => make(lit === '1' ? 'mark' : 'span', [text + '\n']);
  fill($('code').lastElementChild, now.code ?? [], showCode);
  showNumbers();
  showCards();
  drawCards();
  if (stands === '0' && time - spoken < SPOKEN) return;
  spoken = time;
  for (const id of ['picture', 'event']) put($(id), 'textContent', plain(field(id)));
  for (const [index, , kind, , , description] of now.card ?? [])
    if (isDrawn(kind)) put($('graph' + index), 'ariaLabel', plain(description));
};

// Fills the lists of pages, scenes and keys.
const listDocument = () => {
  lists = parseLines(ask('web_get_lists', 'string'));
  const item = (content) => make('li', content);
  for (const id of ['pages', 'scenes']) {
    const links = lists[id].map(([words, text]) => make('a', [text], { href: '#' + words }));
    $(id).lastElementChild.append(...links.map((link) => item([link])));
  }
  const keys = lists.keys.map(([name, does]) => item([make('kbd', [name]), ' ' + does]));
  $('keys').lastElementChild.append(...keys);
};

// ---- buttons and forms ------------------------------------------------------

for (const button of document.querySelectorAll('button[data-key]'))
  button.onclick = () => key(button.dataset.key);
$('step').oninput = () => obey(`goto ${$('step').value}`);
$('guess').onsubmit = (event) => {
  event.preventDefault();
  if (field('asks') !== 'place') return wake(ask('web_answer_question', null, $('answer').value));
  obey(`predict ${$('answer').value} ${$('answer2').value || 0}`);
  key('N');
};

// ---- print ------------------------------------------------------------------

// A page of the lecture: its picture at the step that the page names, open cards
// and room to write; its answer, with the cards that tell it; its notes.
const makeSheet = ([, topic], index) => {
  const head = `${index + 1}. ${topic}`;
  const draw = (show, number, width) => {
    sheet.canvas = make('canvas');
    show(number, width, 620);
    return sheet.canvas;
  };
  const texts = (lines = [], as) => lines.map((line) => paragraph(line, as));
  const picture = draw(Module._web_print_page, index, 900);
  const told = parseLines(ask('web_get_document', 'string'));
  const open = (told.card ?? []).filter(([, , , closed]) => closed === '0');
  const made = open.map(([card, , kind]) =>
    showBody(makeBody(isDrawn(kind) && draw(Module._web_draw_card, card, 720)), card, told),
  );
  Module._web_print_hide_answer();
  const asked = parseLines(ask('web_get_document', 'string'));
  const covered = (asked.card ?? []).flatMap(([card, , kind]) => (kind === 'covered' ? card : []));
  const select = (late) => made.filter((card, i) => covered.includes(open[i][0]) === late);
  const pictures = group('pictures', picture, ...select(false));
  const words = [...texts(asked.text), ...texts(asked.formula, true), make('b', texts(asked.ask))];
  return {
    page: make('section', [make('h2', [head]), pictures, ...words, group('room')]),
    answer: make('div', [make('h3', [head]), ...texts(told.look), ...select(true)]),
    notes: make('div', [make('h3', [head]), ...texts(told.notes)]),
  };
};

const printLecture = () => {
  sheet = {};
  const made = lists.pages.map(makeSheet);
  const columns = (head, what, name) =>
    group(name, make('h2', [head]), ...made.map((one) => one[what]));
  sheet = Module._web_print_page(-1) ?? null;
  $('handout').replaceChildren(
    make('h1', ['Reliable simulation of elastodynamics']),
    ...made.map(({ page }) => page),
    columns('Answers', 'answer', 'columns'),
    columns('Notes for whoever presents it', 'notes', 'columns presented'),
  );
};
addEventListener('beforeprint', () => $('handout').children.length || printLecture());
$('print').onclick = () => print();
