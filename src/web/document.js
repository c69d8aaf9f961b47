// document.js - the text beside the canvas: the lines of document.c as elements.
// A part is made anew only where its lines have changed, so that a selection, or
// what is typed elsewhere, stays.
'use strict';

const LIVE = 100; // ms, at least, between two texts of a run that goes on
const SPOKEN = 4000; // ms, the same of what is read aloud
let now = {}; // word -> lines, each a list of fields
let seen = {}; // part -> its lines as they are shown
let [rendered, spoken] = [-1e9, -1e9]; // when
const cards = new Map(); // index -> canvas
let sheet = null; // {canvas} while the lecture is printed

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

// "page 25" leads there.
const link = (element) => {
  for (const node of [...element.childNodes].filter((child) => child.nodeType === Node.TEXT_NODE))
    node.replaceWith(
      ...node.textContent.split(/(page[ \u00a0]\d+)/i).map((text, i) => {
        const name = i % 2 && lists.pages[text.slice(5) - 1]?.[0];
        return name ? make('a', [text], { href: `#--lecture+${name}` }) : text;
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
    const place = $(word);
    const head = place.dataset.head ? [make('h2', [place.dataset.head])] : [];
    place.hidden = !lines.length;
    place.replaceChildren(...head, ...lines.map((line) => paragraph(line, word === 'formula')));
  });

// ---- numbers ----------------------------------------------------------------

// The number that "Try" wants to be dragged has a slider: over two powers of ten
// around what it is when the page opens, or four times as many and as few.
const plain = (text) => text.replace(/[{}^_]/g, '');
const isTried = (name, label) => {
  const tried = (now.try ?? []).map((line) => plain(line[2])).join(' ');
  const words = tried.match(/\b(Drag|Set)\b[^.;:]*/g)?.join(' ') ?? '';
  return words.split(/[^\p{L}\p{M}\d]+/u).some((word) => word === plain(label) || word === name);
};

const makeSlider = (name, first, whole) => {
  const most = whole ? Math.log(4) : Math.log(10);
  const slider = make('input', [], { type: 'range', min: -most, max: most, step: most / 100 });
  slider.first = first;
  slider.setAttribute('aria-label', `${name}, slider`);
  slider.oninput = () => {
    const number = first * Math.exp(slider.value);
    obey(`set ${name} ${whole ? Math.max(1, Math.round(number)) : Number(number.toPrecision(3))}`);
  };
  return slider;
};

const makeNumber = ([name, label, value, unit, choices, help, , shown]) => {
  const input = make(choices ? 'select' : 'input', [], { name, title: help });
  const words = setMarkup(make('span'), label);
  const item = make('label', [words, input, unit]);
  input.setAttribute('aria-label', label === name ? name : `${words.textContent}, ${name}`);
  if (choices) input.append(...choices.split('|').map((choice) => new Option(choice)));
  else input.inputMode = 'decimal';
  input.onchange = () => obey(`set ${name} ${input.value}`);
  if (shown === '1' && !choices && value > 0 && isTried(name, label)) {
    item.append(makeSlider(name, Number(value), /^\d+$/.test(value) && name === 'segments'));
    item.className = 'tried';
  }
  return item;
};

const makePoint = ([index, x, y]) => {
  const inputs = [x, y].map((value, i) => {
    const input = make('input', [], { value, inputmode: 'decimal' });
    input.setAttribute('aria-label', `point ${index}, ${'xy'[i]} in m`);
    input.onchange = () => obey(`handle ${index} ${inputs[0].value} ${inputs[1].value}`);
    return input;
  });
  return make('span', ['point ', ...inputs]);
};

const makeSwitch = ([index, on, label]) => {
  const input = make('input', [], { type: 'checkbox' });
  input.checked = on === '1';
  input.onchange = () => obey(`flip ${index}`);
  return make('label', [input, setMarkup(make('span'), label)]);
};

const showNumbers = () => {
  const rows = now.number ?? [];
  const shape = JSON.stringify([
    field('page', 2),
    rows.map((row) => [row[0], row[7]]),
    now.try?.length,
  ]);
  if (seen.shape !== shape) {
    const made = rows.map(makeNumber);
    $('numbers').replaceChildren(...made.filter((item, i) => rows[i][7] === '1'));
    $('more').lastElementChild.replaceChildren(...made.filter((item, i) => rows[i][7] !== '1'));
    $('numbers').append(make('span'));
    [seen.shape, seen[['switch', 'point']]] = [shape, null];
  }
  part(['switch', 'point'], () => {
    const exhibit = [...(now.switch ?? []).map(makeSwitch), ...(now.point ?? []).map(makePoint)];
    if (!$('numbers').lastElementChild.contains(document.activeElement))
      $('numbers').lastElementChild.replaceChildren(...exhibit);
  });
  for (const [name, , value, , , , idle] of rows) {
    const input = document.querySelector(`[name="${name}"]`);
    const slider = input.parentNode.querySelector('[type=range]');
    input.disabled = Boolean(idle);
    input.parentNode.title = idle;
    if (document.activeElement !== input) input.value = value;
    if (input.options) input.parentNode.hidden = !input.value; // several, or none
    if (!slider) continue;
    if (document.activeElement !== slider) slider.value = Math.log(value / slider.first);
    slider.setAttribute('aria-valuetext', value);
  }
};

// ---- cards ------------------------------------------------------------------

const makeCard = ([index, name, kind, closed]) => {
  const graph = kind !== 'text';
  const inside = graph ? make('canvas', [], { role: 'img' }) : make('div', [], { class: 'lines' });
  const box = make('div', [inside], { class: graph ? 'paper' : '' });
  const card = make('details', [make('summary'), box], {
    class: `card ${kind}`,
    id: 'card-' + name,
  });
  card.open = closed === '0';
  card.ontoggle = () => tell(REDRAW, { clientX: 0, clientY: 0 });
  if (!graph) return card;
  const larger = make('button', ['⤢'], { 'aria-label': 'Larger, or as before', type: 'button' });
  larger.onclick = () => card.ontoggle(card.classList.toggle('large'));
  box.append(larger);
  cards.set(Number(index), inside);
  return card;
};

// Rows of an algorithm with their values at the right.
const makeRows = (rows) =>
  make('table', [
    ...rows.map(([, lit, struck, indented, text, value], i) => {
      const style = indented === '1' ? { style: 'padding-left: 1.6em' } : {};
      const cells = [make('td', [String(i + 1)]), make('td', [], style), make('td')];
      setMarkup(cells[1], text);
      setMarkup(cells[2], value);
      const line = make('tr', cells, {
        class: (lit === '1' ? 'lit ' : '') + (struck === '1' ? 'struck' : ''),
      });
      if (lit === '1') line.setAttribute('aria-current', 'step');
      return line;
    }),
  ]);

const showCards = () => {
  const all = now.card ?? [];
  const shape = JSON.stringify([field('page', 2), all.map((card) => card.slice(0, 4))]);
  if (seen.cards !== shape) {
    seen.cards = shape;
    cards.clear();
    const made = all.map(makeCard);
    $('graphs').replaceChildren(...made.filter((card, i) => all[i][2] !== 'text'));
    $('cards').replaceChildren(...made.filter((card, i) => all[i][2] === 'text'));
    document.body.classList.toggle('graphs', cards.size > 0);
    document.body.classList.toggle(
      'star',
      all.some((card) => card[2] === 'star'),
    );
  }
  for (const [index, name, kind, , title, words] of all) {
    const card = $('card-' + name);
    const own = (lines) => (lines ?? []).filter((line) => line[0] === index);
    const lines = JSON.stringify([title, words, own(now.words), own(now.row)]);
    if (card.lines === lines) continue;
    card.lines = lines;
    setMarkup(card.querySelector('summary'), title);
    if (kind === 'text')
      card
        .querySelector('.lines')
        .replaceChildren(
          ...own(now.words).map((line) => paragraph(line.slice(1), true)),
          ...(own(now.row).length ? [makeRows(own(now.row))] : []),
        );
    else card.querySelector('canvas').setAttribute('aria-label', plain(`${title}. ${words}`));
  }
  for (const [index, graph] of cards)
    if (graph.clientWidth && graph.clientHeight)
      Module._web_card(index, pixels(graph.clientWidth), pixels(graph.clientHeight));
};

// ---- all of it --------------------------------------------------------------

const openPart = (id) => {
  $(id).open = !$(id).open;
  if ($(id).open) $(id).scrollIntoView({ block: 'start' });
  if ($(id).open) $(id).querySelector('summary').focus({ preventScroll: true });
};

const showPage = ([[number, of, name]]) => {
  $('place').textContent = Number(number) ? `Page ${number} of ${of}` : 'A scene';
  $('before').disabled = number === '1';
  $('after').disabled = number === of;
  for (const item of document.querySelectorAll('footer li a'))
    item.toggleAttribute('aria-current', item.hash.endsWith((Number(number) ? '+' : '#') + name));
  $('pages').open = $('scenes').open = false;
  $('answer').value = $('answer2').value = '';
  if (seen.page) scrollTo(0, 0);
  seen.page = true;
  follow();
};

const showGuess = ([[kind, coordinates] = []]) => {
  const had = $('guess').contains(document.activeElement);
  $('guess').hidden = !kind;
  $('typed').hidden = kind === 'words' || !kind;
  $('second').hidden = coordinates !== '2';
  if (had && !kind) $('told').focus({ preventScroll: true }); // what had the focus is gone
};

// After a frame; what a run that goes on says not in each.
const showDocument = (time) => {
  const paused = field('step', 2) === '1';
  drawn = false;
  if (bare || canvas.hidden) return;
  if (!paused && time - rendered < LIVE && now.page) return showCards();
  rendered = time;
  now = read(ask('web_document', 'string'));
  part(['page'], showPage);
  part(['topic', 'page'], () => {
    setMarkup($('topic'), field('topic') || field('page', 2));
    const number = Number(field('page'));
    document.title = `${number ? number + '. ' : ''}${$('topic').textContent} · elasto`;
  });
  part(['sentence', 'page'], () => {
    $('sentence').hidden = field('page') !== '0';
    setMarkup($('sentence'), field('sentence'));
  });
  part(['time'], () => setMarkup($('time'), field('time')));
  for (const word of ['text', 'formula', 'ask', 'look', 'try', 'claim', 'notes']) showTexts(word);
  $('said-notes').hidden = !now.notes || !/[?&]notes/.test(location.search);
  $('tested').hidden = !now.claim;
  part(['asks', 'page'], () => showGuess(now.asks ?? [[]]));
  part(['told'], () => {
    $('told').className = field('told') === '1' ? 'warning' : '';
    setMarkup($('told'), field('told', 1));
  });
  part(['step'], ([[step, newest, stands]]) => {
    $('step').max = newest;
    if (document.activeElement !== $('step')) $('step').value = step;
    $('play').replaceChildren(stands === '1' ? '▶ Play ' : '❚❚ Pause ', make('kbd', ['Space']));
  });
  part(['picture'], () => ($('picture').textContent = plain(field('picture'))));
  if (field('step', 2) === '1' || time - spoken > SPOKEN)
    part(['event'], () => ($('event').textContent = plain(field('event', (spoken = time) * 0))));
  part(['code'], (lines) => {
    $('code').hidden = !lines.length;
    const made = lines.map(([lit, text]) => make(lit === '1' ? 'mark' : 'span', [text + '\n']));
    $('code').lastElementChild.replaceChildren(...made);
  });
  showNumbers();
  showCards();
};

// What never changes.
let lists = {};
const listDocument = () => {
  lists = read(ask('web_lists', 'string'));
  const entry = (href, text) => make('li', [make('a', [text], { href })]);
  const pages = lists.pages.map(([name, topic]) => entry(`#--lecture+${name}`, topic));
  const scenes = lists.scenes.map(([name, text]) => entry(`#${name}`, `${name}: ${text}`));
  const keys = lists.keys.flatMap(([key, does]) => [
    make('dt', [make('kbd', [key])]),
    make('dd', [does]),
  ]);
  $('pages').lastElementChild.replaceChildren(...pages);
  $('scenes').lastElementChild.replaceChildren(...scenes);
  $('keys').lastElementChild.replaceChildren(...keys);
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
  if (x && field('asks') === 'place') (obey(`predict ${x} ${y || 0}`), key('N', false));
  else if (x) wake(ask('web_answer', null, x));
};

// ---- print ------------------------------------------------------------------

// A sheet has two pages of the lecture, each with its picture at the step that it
// names and room to write; behind them are the answers, and the notes with ?notes.
const makeSheet = (index) => {
  const [name, topic] = lists.pages[index];
  const head = `${index + 1}. ${topic}`;
  const pictures = make('div', [], { class: 'pictures' });
  const draw = (card, width, height) => {
    pictures.append((sheet.canvas = make('canvas')));
    if (card >= 0) Module._web_card(card, width, height);
    else Module._web_sheet_draw(width, height);
  };
  Module._web_sheet(index);
  draw(-1, 900, 620);
  const told = read(ask('web_document', 'string'));
  for (const [card, , kind, closed] of told.card ?? [])
    if (kind !== 'text' && closed === '0') draw(Number(card), 720, 620);
  Module._web_sheet_veil();
  const asked = read(ask('web_document', 'string'));
  const texts = (lines, as) => (lines ?? []).map((line) => paragraph(line, as));
  const address = `elasto.html#--lecture+${name}`;
  const live = make('p', [
    make('a', ['live: ' + address], { href: location.pathname + '#--lecture+' + name }),
  ]);
  const question = make('div', texts(asked.ask), { style: 'font-weight: bold' });
  const words = [...texts(asked.text), ...texts(asked.formula, true), question];
  const page = make('section', [
    make('h2', [head]),
    pictures,
    ...words,
    make('div', [], { class: 'room' }),
    live,
  ]);
  const shown = new Set((asked.formula ?? []).map(String));
  const more = (told.formula ?? []).filter((line) => !shown.has(String(line)));
  const answer = make('div', [make('h3', [head]), ...texts(told.look), ...texts(more, true)], {
    class: 'answer',
  });
  const notes = make('div', [make('h3', [head]), ...texts(told.notes)], { class: 'answer' });
  return { page, answer, notes };
};

const printLecture = () => {
  sheet = {};
  const made = lists.pages.map((page, index) => makeSheet(index));
  sheet = null;
  Module._web_sheet(-1);
  const title = make('h1', ['Reliable simulation of elastodynamics']);
  const parts = [
    title,
    ...made.map(({ page }) => page),
    make('h2', ['Answers']),
    ...made.map(({ answer }) => answer),
  ];
  if (/[?&]notes/.test(location.search))
    parts.push(make('h2', ['Notes for whoever presents it']), ...made.map(({ notes }) => notes));
  $('handout').replaceChildren(...parts);
};
addEventListener('beforeprint', () => $('handout').children.length || printLecture());
$('print').onclick = () => print();
