// document.js - the text beside the canvas: the lines of document.c as elements.
// A part is made anew only where its lines have changed, so that a selection, or
// what is typed elsewhere, stays.
'use strict';

const LIVE = 100; // ms, at least, between two texts of a run that goes on
const SPOKEN = 4000; // ms, the same of what is read aloud
let now = {}; // word -> lines, each a list of fields
let lists = {}; // the same of pages, scenes and keys
const seen = {}; // part -> its lines as they are shown
let [rendered, spoken, late] = [-1e9, -1e9, 0]; // when; the timer of the next text
const cards = new Map(); // index -> canvas
let sheet = null; // {canvas} while the lecture is made for print

const read = (text) => {
  const lines = {};
  for (const line of text.split('\n')) {
    const [word, ...fields] = line.split('\t');
    if (word) (lines[word] ??= []).push(fields);
  }
  return lines;
};
const field = (word, i = 0) => now[word]?.[0][i] ?? '';
const obey = (line) => wake(ask('web_obey', null, line));

// Calls `build` where one of these words says something else than before.
const part = (words, build) => {
  const lines = JSON.stringify(words.map((word) => now[word]));
  if (seen[words] === lines) return;
  seen[words] = lines;
  build(now[words[0]] ?? []);
};

// ---- texts ------------------------------------------------------------------

const plain = (text) => text.replace(/[{}^_]/g, '');

// "page 25" leads there.
const link = (element) => {
  for (const node of [...element.childNodes].filter((child) => child.nodeType === Node.TEXT_NODE))
    node.replaceWith(
      ...node.textContent.split(/(page[ \u00a0]\d+)/i).map((text, i) => {
        const words = i % 2 && lists.pages[text.slice(5) - 1]?.[0];
        return words ? make('a', [text], { href: '#' + words }) : text;
      }),
    );
  return element;
};

const paragraph = ([colour, bold, text], asFormula) => {
  const p = link(setMarkup(make('p', [], asFormula ? { class: 'formula' } : {}), text, asFormula));
  if (colour !== '#1c1c1c') p.style.color = colour;
  if (bold === '1') p.style.fontWeight = 'bold';
  return p;
};

const showTexts = (word) =>
  part([word], (lines) => {
    const { head } = $(word).dataset;
    const paragraphs = lines.map((line) => paragraph(line, word === 'formula'));
    $(word).hidden = !lines.length;
    $(word).replaceChildren(...(head ? [make('h2', [head])] : []), ...paragraphs);
  });

// ---- numbers ----------------------------------------------------------------

const input = (name, label, value, change, more = {}) => {
  const how = { 'aria-label': label, inputmode: 'decimal', name, value, ...more };
  return Object.assign(make('input', [], how), { onchange: change });
};

// Over two powers of ten around what the number is when the page opens, or four
// times as many and as few.
const makeSlider = (name, first, whole) => {
  const most = Math.log(whole ? 4 : 10);
  const range = { type: 'range', min: -most, max: most, step: most / 100 };
  const slider = input('', name, 0, null, range);
  slider.first = first;
  slider.oninput = () => {
    const number = first * Math.exp(slider.value);
    obey(`set ${name} ${whole ? Math.max(1, Math.round(number)) : Number(number.toPrecision(3))}`);
  };
  return slider;
};

const makeNumber = ([name, label, value, unit, choices, , , shown]) => {
  const words = setMarkup(make('span'), label);
  const full = label === name ? name : `${words.textContent}, ${name}`;
  const change = ({ target }) => obey(`set ${name} ${target.value}`);
  const options = choices.split('|').map((choice) => new Option(choice));
  const select = Object.assign(make('select', options), {
    name,
    ariaLabel: full,
    onchange: change,
  });
  const element = choices ? select : input(name, full, value, change);
  const item = make('label', [words, element, setMarkup(make('span'), unit)]);
  if (shown !== 'tried') return item;
  item.append(makeSlider(name, Number(value), name === 'segments'));
  item.className = 'tried';
  return item;
};

// Points that can be dragged, and switches.
const makePoint = ([index, x, y]) => {
  const send = () => obey(`handle ${index} ${fields[0].value} ${fields[1].value}`);
  const fields = [x, y].map((value, i) => input('', `point ${index}, ${'xy'[i]}`, value, send));
  return make('label', ['point', ...fields, 'm']);
};
const makeSwitch = ([index, on, label]) => {
  const box = input('', plain(label), '', () => obey(`flip ${index}`), { type: 'checkbox' });
  box.checked = on === '1';
  return make('label', [box, setMarkup(make('span'), label)]);
};

const showNumbers = () => {
  const rows = now.number ?? [];
  const names = rows.map(([name, , , , , , , shown]) => name + shown);
  const shape = JSON.stringify([field('page', 2), names]);
  if (seen.shape !== shape) {
    const made = rows.map(makeNumber);
    const of = (shown) => made.filter((item, i) => (rows[i][7] !== 'more') === shown);
    $('row').replaceChildren(...of(true));
    $('more').lastElementChild.replaceChildren(...of(false));
    seen.shape = shape;
  }
  if (!$('exhibit').contains(document.activeElement))
    part(['switch', 'point'], (switches) => {
      const points = (now.point ?? []).map(makePoint);
      $('exhibit').replaceChildren(...switches.map(makeSwitch), ...points);
    });
  for (const [name, , value, , , help, idle] of rows) {
    const element = document.querySelector(`[name="${name}"]`);
    const slider = element.parentNode.querySelector('[type=range]');
    element.parentNode.title = idle || help;
    element.disabled = Boolean(idle);
    if (document.activeElement !== element) element.value = value;
    if (element.options) element.parentNode.hidden = !element.value; // several, or none
    if (!slider) continue;
    slider.setAttribute('aria-valuetext', value);
    if (document.activeElement !== slider) slider.value = Math.log(value / slider.first);
  }
};

// ---- cards ------------------------------------------------------------------

const makeCard = ([index, name, kind, closed]) => {
  const graph = kind !== 'text' && make('canvas', [], { role: 'img' });
  const box = make('div', graph ? [graph] : [], { class: graph ? 'paper' : 'lines' });
  const card = make('details', [make('summary'), box], { class: kind, id: 'card-' + name });
  card.open = closed === '0';
  card.ontoggle = () => tell(REDRAW, { clientX: 0, clientY: 0 });
  if (!graph) return card;
  const larger = make('button', ['⤢'], { 'aria-label': 'Larger, or as before' });
  larger.onclick = () => card.ontoggle(card.classList.toggle('large'));
  box.append(larger);
  cards.set(Number(index), graph);
  return card;
};

// An algorithm line by line, with the values at the right.
const makeRow = ([, lit, struck, indented, text, value], i) => {
  const cells = [[String(i + 1)], [], []].map((content) => make('td', content));
  const line = make('tr', cells, lit === '1' ? { class: 'lit', 'aria-current': 'step' } : {});
  setMarkup(cells[1], text).classList.toggle('indented', indented === '1');
  setMarkup(cells[2], value);
  line.classList.toggle('struck', struck === '1');
  return line;
};

const showCards = () => {
  const all = now.card ?? [];
  const shape = JSON.stringify([field('page', 2), all.map((card) => card.slice(0, 4))]);
  if (seen.cards !== shape) {
    seen.cards = shape;
    cards.clear();
    const made = all.map(makeCard);
    $('graphs').replaceChildren(...made.filter((card) => card.className !== 'text'));
    $('cards').replaceChildren(...made.filter((card) => card.className === 'text'));
  }
  for (const [index, name, , , title, words] of all) {
    const own = (lines) => (lines ?? []).filter((line) => line[0] === index);
    const lines = JSON.stringify([title, words, own(now.words), own(now.row)]);
    const [card, graph] = [$('card-' + name), cards.get(Number(index))];
    if (card.lines === lines) continue;
    card.lines = lines;
    setMarkup(card.firstElementChild, title);
    graph?.setAttribute('aria-label', plain(`${title}. ${words}`));
    if (graph) continue;
    const texts = own(now.words).map((line) => paragraph(line.slice(1), true));
    card.lastElementChild.replaceChildren(...texts, make('table', own(now.row).map(makeRow)));
  }
  for (const [index, graph] of cards)
    if (graph.clientWidth && graph.clientHeight)
      Module._web_draw_card(index, pixels(graph.clientWidth), pixels(graph.clientHeight));
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
  $('answer').value = $('answer2').value = '';
  scrollTo(0, 0);
  follow();
};

const showGuess = ([[kind, coordinates] = []]) => {
  const had = $('guess').contains(document.activeElement);
  $('guess').hidden = !kind;
  $('typed').hidden = kind === 'words';
  $('second').hidden = kind !== 'place' || coordinates === '1';
  $('how').textContent = kind === 'place' ? 'Click in the picture, or x' : 'Your answer';
  if (had && !kind) $('verdict').focus({ preventScroll: true }); // what had it is gone
};

// After a frame; of a run that goes on not after each.
const showDocument = (time) => {
  drawn = false;
  if (bare || canvas.hidden) return;
  clearTimeout(late);
  if (field('step', 2) === '0' && time - rendered < LIVE) {
    late = setTimeout(() => showDocument(performance.now()), LIVE); // if it was the last one
    return showCards();
  }
  rendered = time;
  now = read(ask('web_document', 'string'));
  const number = Number(field('page'));
  part(['page'], showPage);
  part(['topic', 'page'], () => {
    setMarkup($('topic'), field('topic') || field('page', 2));
    document.title = `${number ? number + '. ' : ''}${$('topic').textContent} · elasto`;
  });
  part(['sentence', 'page'], () => setMarkup($('sentence'), number ? '' : field('sentence')));
  part(['time'], () => setMarkup($('time'), field('time')));
  for (const word of ['text', 'formula', 'ask', 'look', 'try', 'claim', 'notes']) showTexts(word);
  part(['asks', 'page'], showGuess);
  part(['verdict', 'page'], ([[text = '', right, guesses] = []]) =>
    setMarkup($('verdict'), text + (guesses > 1 ? ` ${right} of ${guesses} so far.` : '')),
  );
  part(['told', 'verdict'], ([[warning, text]]) => {
    $('told').className = warning === '1' ? 'warning' : '';
    setMarkup($('told'), now.verdict && / it is /.test(text) ? '' : text);
  });
  part(['step'], ([[step, newest, stands]]) => {
    $('step').max = newest;
    if (document.activeElement !== $('step')) $('step').value = step;
    $('play').firstElementChild.textContent = stands === '1' ? '▶' : '❚❚';
  });
  part(['picture'], () => ($('picture').textContent = plain(field('picture'))));
  if (field('step', 2) === '1' || time - spoken > SPOKEN) {
    part(['event'], () => ($('event').textContent = plain(field('event'))));
    spoken = time;
  }
  part(['code'], (lines) => {
    const made = lines.map(([lit, text]) => make(lit === '1' ? 'mark' : 'span', [text + '\n']));
    $('code').lastElementChild.replaceChildren(...made);
  });
  showNumbers();
  showCards();
};

// What never changes.
const listDocument = () => {
  lists = read(ask('web_lists', 'string'));
  const item = (content) => make('li', content);
  for (const id of ['pages', 'scenes']) {
    const links = lists[id].map(([words, text]) => make('a', [text], { href: '#' + words }));
    $(id).lastElementChild.append(...links.map((link) => item([link])));
  }
  const keys = lists.keys.map(([name, does]) => item([make('kbd', [name]), ' ' + does]));
  $('keys').lastElementChild.append(...keys);
};

// ---- what is pressed --------------------------------------------------------

for (const button of document.querySelectorAll('button[data-key]'))
  button.onclick = () => key(button.dataset.key, false);
$('step').oninput = () => obey(`goto ${$('step').value}`);
$('numbers').onsubmit = (event) => event.preventDefault();
$('show').onclick = () => wake(ask('web_answer', null, ''));
$('guess').onsubmit = (event) => {
  const [x, y] = [$('answer').value, $('answer2').value];
  event.preventDefault();
  if (!x) return;
  if (field('asks') !== 'place') return wake(ask('web_answer', null, x));
  obey(`predict ${x} ${y || 0}`);
  key('N', false);
};

// ---- print ------------------------------------------------------------------

// A page of the lecture with its picture at the step that it names and room to
// write; its answer and its notes.
const makeSheet = ([, topic], index) => {
  const head = `${index + 1}. ${topic}`;
  const pictures = make('div', [], { class: 'pictures' });
  const draw = (card, width) => {
    pictures.append((sheet.canvas = make('canvas')));
    Module._web_sheet_draw(card, width, 620);
  };
  const texts = (lines = [], as) => lines.map((line) => paragraph(line, as));
  Module._web_sheet(index);
  const told = read(ask('web_document', 'string'));
  draw(-1, 900);
  for (const [card, , kind, closed] of told.card ?? [])
    if (kind !== 'text' && closed === '0') draw(Number(card), 720);
  Module._web_sheet_veil();
  const asked = read(ask('web_document', 'string'));
  const room = make('div', [], { class: 'room' });
  const question = make('b', texts(asked.ask));
  const words = [...texts(asked.text), ...texts(asked.formula, true), question, room];
  return {
    page: make('section', [make('h2', [head]), pictures, ...words]),
    answer: make('div', [make('h3', [head]), ...texts(told.look)]),
    notes: make('div', [make('h3', [head]), ...texts(told.notes)]),
  };
};

const printLecture = () => {
  sheet = {};
  const made = lists.pages.map(makeSheet);
  const columns = (head, what, name) =>
    make('div', [make('h2', [head]), ...made.map((one) => one[what])], { class: name });
  sheet = Module._web_sheet(-1) ?? null;
  $('handout').replaceChildren(
    make('h1', ['Reliable simulation of elastodynamics']),
    ...made.map(({ page }) => page),
    columns('Answers', 'answer', 'columns'),
    columns('Notes for whoever presents it', 'notes', 'columns presented'),
  );
};
addEventListener('beforeprint', () => $('handout').children.length || printLecture());
$('print').onclick = () => print();
