// check_document.js ELASTO PAGE [AXE]: checks the texts beside the canvas.
// No text is cut in any size, formulas are MathML, and the tour works by keys and a
// screen reader's tree.  Addresses, history, frames in other pages, print.  AXE:
// axe.min.js of axe-core; without AXE its check is skipped.
'use strict';
const { spawnSync } = require('child_process');
const fs = require('fs');
const os = require('os');
const path = require('path');
const { launch, sleep, verdict, finish } = require('./browser.js');
const firefox = require('./firefox.js');

const [elasto, page, axe] = process.argv.slice(2).map((name) => path.resolve(name));
const at = (line, query = '') => `file://${page}${query}#${line.replace(/ /g, '+')}`;
const listed = (line) =>
  spawnSync(elasto, line.split(' '), { encoding: 'utf8' }).stdout.trim().split('\n');
const PAGES = listed('--list --lecture').map((row) => row.trim().split(/\s+/)[1]);

// Opens a page of the tour, or a scene, in a tab and waits until the document shows it.
const turnTo = async (tab, name) => {
  await tab.run(`location.hash = '${PAGES.includes(name) ? '--lecture+' : ''}${name}'`);
  await tab.until(`field('page', 2) === '${name}' && !drawn`);
};
const answer = async (tab) => {
  await tab.run(`field('asks') && key('N')`);
  await tab.until(`!field('asks')`);
};

// Returns the words that are wider than their box, outside the window, or covered
// by the picture after a scroll to them; and apart from these the elements with a
// scroll bar of their own, such as long formulas.
const CUT = `(() => {
  const wrong = [];
  const wide = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > wide) wrong.push('the page scrolls sideways');
  const graphs = $('graphs');
  if (graphs.scrollWidth > graphs.clientWidth || graphs.scrollHeight > graphs.clientHeight)
    wrong.push('the graphs scroll');
  if ((innerWidth > 739 || innerWidth > innerHeight) !== ($('words').offsetLeft > 99)) wrong.push('columns');
  if ($('look').getBoundingClientRect().top > innerHeight - 40) wrong.push('the answer is out of sight');
  for (const element of document.querySelectorAll(
    'h1, h2, p, summary, label, button, input, select, math, output, #bar > *, td')) {
    const box = element.getBoundingClientRect();
    if (!box.width || element.closest('.unseen, dialog, #handout, .cells') || element.closest('[hidden]')) continue;
    const words = element.id || element.className || element.textContent.slice(0, 30);
    if (box.left < -1 || box.right > wide + 1) wrong.push(element.localName + ' ' + words + ' beyond the window');
    if (/^(p|h1|summary|button|label|output)$/.test(element.localName) && element.clientWidth && element.scrollWidth > element.clientWidth + 1)
      wrong.push(element.localName + ' ' + words + ' is cut by ' + (element.scrollWidth - element.clientWidth));
  }
  for (const graph of document.querySelectorAll('#graphs [open] canvas'))
    if (graph.clientHeight < 60) wrong.push(graph.ariaLabel + ' is ' + graph.clientHeight + ' high');
  if (Page.letter() < 0.7 * parseFloat(getComputedStyle($('words')).fontSize)) wrong.push('letters of graphs');
  const [bar, last] = [$('bar'), $('after')].map((element) => element.getBoundingClientRect());
  if (last.bottom > bar.bottom + 1) wrong.push('a button is cut');
  const ask = document.querySelector('#ask p');
  if (ask) {
    ask.scrollIntoView({ block: 'center' });
    const box = ask.getBoundingClientRect();
    const top = document.elementFromPoint(box.left + 5, box.top + box.height / 2);
    if (!ask.contains(top) && top !== ask) wrong.push('the question is covered');
    scrollTo(0, 0);
  }
  return wrong;
})()`;

// Returns the elements of MathML with a wrong number of children or an empty child.
const MATH = `[...document.querySelectorAll('math *')].filter((element) => {
  const needed = { mfrac: 2, msup: 2, msub: 2, mover: 2, msubsup: 3, msqrt: 1 }[element.localName];
  const empty = /^m([ion]|text)$/.test(element.localName) && !element.textContent;
  return (needed && element.children.length !== needed) || empty || /[{}#\\\\]|_\\{/.test(element.textContent);
}).map((element) => element.outerHTML.slice(0, 80))`;

const SHEET = { width: 711, height: 1062, deviceScaleFactor: 1, mobile: false };
const PORTRAIT = ['360x740', '390x844', '744x1133', '820x1180'];
const LANDSCAPE = ['683x384', '844x390', '1024x600', '1366x768', '1920x1080', '2560x1440'];

const nothingIsCut = async (tab, size, resize) => {
  const [width, height] = size.split('x').map(Number);
  const wrong = [];
  await resize(width, height);
  for (const name of ['square', ...PAGES]) {
    await turnTo(tab, name);
    for (const told of [false, true]) {
      if (told) await answer(tab);
      const found = [...(await tab.run(CUT)), ...(await tab.run(MATH))];
      wrong.push(...found.map((what) => `${name} ${size}: ${what}`));
    }
  }
  await turnTo(tab, 'square'); // one of its four graphs is enlarged and made small again
  await tab.run(`flip = () => document.querySelector('#graphs button').click(), flip()`);
  const high = await tab.run(`document.querySelector('.large .figure').clientHeight / innerHeight`);
  if (high < 0.6) wrong.push(`${size}: an enlarged graph has ${high} of the height`);
  await tab.run('flip()');
  return wrong;
};

const sizes = async (browser) => {
  const tab = await browser.open(at(''));
  const wrong = [];
  const device = { deviceScaleFactor: 1, mobile: true };
  const resize = (width, height) =>
    tab.ask('Emulation.setDeviceMetricsOverride', { width, height, ...device });
  for (const size of [...PORTRAIT, ...LANDSCAPE])
    wrong.push(...(await nothingIsCut(tab, size, resize)));
  verdict('nothing_is_cut_in_any_size_in_Chromium', [...wrong, ...tab.trouble]);
  await tab.close();
};

// Checks by keys alone, in the accessibility tree, that a page's question, answer,
// formulas and numbers with their values are there.
const tree = async (tab) => {
  const { nodes } = await tab.ask('Accessibility.getFullAXTree');
  const found = new Map(nodes.map((node) => [node.nodeId, node]));
  const inOrder = (node) =>
    node ? [node, ...node.childIds.flatMap((id) => inOrder(found.get(id)))] : [];
  return inOrder(nodes[0])
    .filter(({ ignored, name }) => !ignored && name?.value)
    .map(({ role, name, value }) => ({ role: role.value, name: name.value, value: value?.value }));
};
const squeezed = (text) => text.normalize('NFKC').replace(/\s+/g, '');

const SLIDERS = ['dial timestep Home 0.01', 'bodies young End 2e5', 'order stiffness End 1e9'];
const tourByKeys = async (browser) => {
  const tab = await browser.open(at(''));
  const wrong = [];
  await tab.until(`field('page', 2)`);
  for (const [i, name] of PAGES.entries()) {
    for (const told of [false, true]) {
      if (told) await tab.key('n'); // the answer
      await tab
        .until(`!${told} || !field('asks')`, 20000)
        .catch(() => wrong.push(`${name}: N does not show the answer`));
      const nodes = await tree(tab);
      const leaves = nodes.filter(({ role }) => role === 'StaticText');
      const said = squeezed(leaves.map((node) => node.name).join(''));
      const words = `[...document.querySelectorAll('#topic, :is(#text, #ask, #formula, #look, #try) p')]
        .map((p) => p.textContent)`;
      for (const text of await tab.run(words))
        if (!said.includes(squeezed(text).slice(0, 12)))
          wrong.push(`${name}: '${text}' is not in the tree`);
      const fields = `now.number.filter((row) => row[7] !== 'others' && !row[4])`; // no names
      for (const [label, , value] of await tab.run(fields))
        if (!nodes.some((node) => node.name.includes(label) && (node.value ?? '') === value))
          wrong.push(`${name}: no field ${label} ${value}`);
    }
    if (!(await tab.run('document.title')).startsWith(`${i + 1}. `))
      wrong.push(`${name}: the title`);
    const picture = await tab.run(`$('picture').textContent`);
    if (!/energ|point|masses/i.test(picture) && !/trust|race|order/.test(name))
      wrong.push(`${name}: the picture has no words`);
    // Text of Try outside its buttons.  Units and letters of formulas are not counted.
    const rest = await tab.run(`[...$('try').querySelectorAll('p')].flatMap(({ childNodes }) =>
      [...childNodes].map((node) => (node.nodeType === 3 ? node.data : '|'))).join('')`);
    if (/\b([Pp]ress|[Kk]ey|then|and) (Space|[NRI])\b/.test(rest))
      wrong.push(`${name}: Try names a key that is no button: ${rest}`);
    if (i + 1 < PAGES.length) await tab.key('PageDown');
    await tab.until(`field('page', 2) === '${PAGES[Math.min(i + 1, PAGES.length - 1)]}'`);
  }
  // A slider reaches a number that Try names, here by keys.
  for (const [name, label, key, number] of SLIDERS.map((text) => text.split(' '))) {
    await turnTo(tab, name);
    await answer(tab);
    await tab.run(`document.querySelector('#tried [aria-label=${label}]').focus()`);
    await tab.key(key);
    await tab
      .until(`Number(document.querySelector('#tried [name=${label}]').value) === ${number}`, 20000)
      .catch(() => wrong.push(`no slider moves ${label} to ${number}`));
  }
  await turnTo(tab, 'stability');
  await answer(tab);
  const root = await tab.run(`document.querySelector('#look msqrt').textContent`);
  if (root !== '1+h2ω2') wrong.push(`the root of ${root}`);
  // Legends are text.  A switch is a checkbox; a bare page draws it in the picture.
  await turnTo(tab, 'landscape');
  const boxes = (await tree(tab)).filter(({ role }) => role === 'checkbox').length;
  if (boxes !== 2) wrong.push(`${boxes} checkboxes`);
  await turnTo(tab, 'drop');
  const leaves = (await tree(tab)).map(({ name }) => name);
  for (const name of ['exact', 'kinetic', 'elastic'])
    if (!leaves.includes(name)) wrong.push(`no ${name} in a legend`);
  // Tab reaches picture, buttons, fields and lists, and each shows its focus.
  const reached = new Set();
  await tab.run(`turnTo = location.hash = '--lecture+${PAGES[1]}'; document.activeElement.blur()`);
  await tab.until(`field('asks') === 'number'`);
  for (let i = 0; i < 60; i++) {
    await tab.key('Tab');
    const focus = 'document.activeElement';
    reached.add(await tab.run(`${focus}.id || ${focus}.name || ${focus}.parentNode.id`));
    const outline = await tab.run(`getComputedStyle(document.activeElement).outlineStyle`);
    if (outline === 'none' && (await tab.run('document.activeElement !== document.body')))
      wrong.push(`no focus is seen on ${[...reached].pop()}`);
  }
  const all =
    'canvas play step all after answer show segments timestep more pages scenes keys print';
  for (const id of all.split(' ')) if (!reached.has(id)) wrong.push(`Tab does not reach ${id}`);
  await tab.run(`canvas.focus()`);
  for (const key of ['q', 'Escape', 'Escape']) await tab.key(key);
  const frames = await tab.run('stats.frames');
  await tab.key('n');
  await tab
    .until(`stats.frames > ${frames}`, 20000)
    .catch(() => wrong.push('q or Escape ends the page'));
  verdict('keys_and_a_readers_tree_lead_through_the_tour', [...wrong, ...tab.trouble]);
  await tab.close();
};

// Each page that asks for a number or place judges a wrong guess, and then the right
// one, which the verdict or the moved point tells.  A digit in the canvas begins a guess.
const answers = async (browser) => {
  const tab = await browser.open(at(''));
  const wrong = [];
  let judged = 0;
  for (const name of PAGES) {
    let guess = ['12345', '12345'];
    for (const expected of [/It is|off\.$/, /right\.$/]) {
      await turnTo(tab, 'square');
      await turnTo(tab, name);
      const kind = await tab.run(`field('asks')`);
      if (kind === 'words') break;
      await tab.run(kind === 'number' ? 'canvas.focus()' : `$('answer').focus()`);
      for (const sign of guess[0]) await tab.key(sign);
      await tab.run(`$('answer2').value = '${guess[1]}'`);
      await tab.key('Enter');
      await tab.until(`$('verdict').textContent && (${kind === 'number'} || field('step') > 0)`);
      const told = await tab.run(`$('verdict').textContent`);
      if (!expected.test(told)) wrong.push(`${name}: ${told}`);
      if ((await tab.run('document.activeElement.id')) !== 'look') wrong.push('the focus is lost');
      guess =
        told.match(/(?<=It is )[\d.]+(?=\.)/) ??
        (await tab.run(`now.point?.[${name === 'newton' ? 1 : 0}].slice(1)`)) ??
        guess;
      judged++;
    }
  }
  if (judged !== 26) wrong.push(`${judged} guesses`);
  verdict('each_page_judges_a_wrong_and_a_right_guess', [...wrong, ...tab.trouble]);
  await tab.close();
};

// The wheel scrolls the page before a click in the picture, and zooms after it.
const wheelWaits = async (tab, wrong) => {
  await tab.run(`canvas.blur(); wheels = [];
    addEventListener('wheel', (event) => wheels.push(event.defaultPrevented))`);
  for (const type of ['mouseWheel', 'mousePressed', 'mouseReleased', 'mouseWheel'])
    await tab.mouse(type, 200, 200, { deltaX: 0, deltaY: 100 });
  await tab.until('wheels.length > 1');
  const taken = await tab.run('wheels.join()');
  if (taken !== 'false,true') wrong.push(`the wheel before and after a click: ${taken}`);
};

// The program does not take the browser's own keys.
const keysOfBrowser = async (browser) => {
  const tab = await browser.open(at('square --paused'));
  const wrong = [];
  await tab.run(`taken = [];
    addEventListener('keydown', (event) => event.defaultPrevented && taken.push(event.key))`);
  for (const key of ['f', 'p', 'l', 'c', 'r'])
    for (const held of [1, 2, 4]) await tab.key(key, held); // Alt, Ctrl, Meta
  for (const key of ['F5', 'F12', 'Tab', 'n', 'Home']) await tab.key(key); // Tab leaves the canvas
  const taken = await tab.run('taken');
  if (taken.length) wrong.push(`takes ${taken}`);
  await wheelWaits(tab, wrong);
  verdict('keys_and_wheel_of_the_browser_stay_its_own', [...wrong, ...tab.trouble]);
  await tab.close();
};

const history = async (browser) => {
  const tab = await browser.open(at(''));
  const wrong = [];
  const leads = async (deed, name) => {
    await tab.run(deed);
    await tab
      .until(`typeof field !== 'undefined' && field('page', 2) === '${name}'`, 20000)
      .catch(async () => wrong.push(`${deed}: ${await tab.run('location.hash')}, not ${name}`));
  };
  await leads('0', PAGES[0]);
  await leads(`key('PageDown')`, PAGES[1]);
  await leads(`key('PageDown')`, PAGES[2]);
  await leads('history.back()', PAGES[1]);
  await leads('history.back()', PAGES[0]);
  await leads('history.forward()', PAGES[1]);
  await tab.run(`obey('set timestep 0.02')`); // no address leads to another h of a page
  await sleep(1500);
  await tab.run(`location.reload()`);
  await sleep(300);
  await leads('0', PAGES[1]);
  await leads(`location.hash = '--lecture+explicit'`, 'explicit');
  await leads(`document.querySelector('#text a').click()`, 'stability');
  await leads(`document.querySelector('#pages a[href$="${PAGES[8]}"]').click()`, PAGES[8]);
  verdict('back_forward_reload_and_links_lead_to_their_page', [...wrong, ...tab.trouble]);
  await tab.close();

  const bad = [];
  const lines = ['nonsense', '--lecture nosuch', 'square --segments 0', 'square --timestep'];
  for (const line of lines) {
    const lost = await browser.open(at(line));
    await lost
      .until(`field('page', 2) === '${PAGES[0]}'`, 20000)
      .catch(() => bad.push(`${line}: no tour`));
    if (!/^elasto: [^\n]+$/.test(await lost.run(`$('said').textContent`)))
      bad.push(`${line}: no line`);
    // After a second wrong address the texts of the tour still change.
    await lost.run(`location.hash = 'nonsense&bare'`);
    await lost
      .until(`!bare && location.hash === '#--lecture'`, 20000)
      .catch(() => bad.push(`${line}: bare`));
    await lost.close();
  }
  verdict('a_wrong_address_shows_the_tour_and_one_line', bad);
};

// Checks that three frames far down in a course's page change neither focus nor scroll.
const frames = async (browser) => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'elasto-frames-'));
  const file = path.join(folder, 'course.html');
  const frame = (line) => `<iframe src="${at(line)}&bare" width="400" height="300"></iframe>`;
  const lines = ['circle --timestep 0.05', '--lecture newton', 'drop'];
  const stats = 'stats = { first: 1 }; $ = (id) => document.getElementById(id)';
  const above = '<input id="here" autofocus><div style="height: 2000px"></div>';
  fs.writeFileSync(file, `<script>${stats}</script>${above}${lines.map(frame).join('')}`);
  const tab = await browser.open('file://' + file, { width: 1000, height: 700 });
  const wrong = [];
  await tab.until(`document.activeElement.id === 'here'`);
  await sleep(3000);
  if (await tab.run('scrollY')) wrong.push('the page scrolled');
  if ((await tab.run('document.activeElement.id')) !== 'here') wrong.push('the focus was taken');
  // A finger scrolls past a frame; after a tap in the frame a finger pulls the square.
  const swipe = async () => {
    await tab.run('scrollTo(0, 1700)');
    await tab.touch('touchStart', [200, 500]);
    for (let i = 1; i <= 10; i++) await tab.touch('touchMove', [200, 500 - 15 * i]);
    await tab.touch('touchEnd');
    return tab.run('scrollY - 1700');
  };
  if ((await swipe()) < 50) wrong.push('a finger does not scroll past a frame');
  await tab.run('scrollTo(0, 1700)');
  await tab.touch('touchStart', [200, 400]);
  await tab.touch('touchEnd');
  await tab.until(`document.activeElement.tagName === 'IFRAME'`);
  if (await swipe()) wrong.push('a finger scrolls a frame that was tapped');
  await tab.close();
  const bare = await browser.open(at('circle') + '&bare', { width: 400, height: 300 });
  const seen = `[...document.querySelectorAll('body > *')].filter((e) => e.getBoundingClientRect().width > 0).map((e) => e.id).join()`;
  if ((await bare.run(seen)) !== 'stage') wrong.push(`bare shows ${await bare.run(seen)}`);
  // A finger that scrolls does not pull the square.
  await bare.run(`canvas.blur(); kinds = []; told = Module._web_queue_mouse;
    Module._web_queue_mouse = (...how) => kinds.push(how[0]) && told(...how)`);
  await bare.touch('touchStart', [200, 200]);
  await bare.touch('touchMove', [200, 180]);
  await bare.touch('touchEnd');
  if (await bare.run('kinds.includes(PRESS)')) wrong.push('a finger that scrolls pulls');
  await wheelWaits(bare, wrong);
  await bare.run(`$('replay').click()`);
  await bare.until(`stats.frames > 3`);
  wrong.push(...tab.trouble, ...bare.trouble);
  verdict('bare_frames_take_no_focus_and_have_a_button', wrong);
  await bare.close();
  fs.rmSync(folder, { recursive: true });
};

// Checks the number of A4 sheets that Chromium prints, and that words can be searched.
const print = async (browser) => {
  const wrong = [];
  for (const [query, more] of Object.entries({ '': 2, '?notes': 7 })) {
    const tab = await browser.open(at('', query));
    const pdf = await tab.print();
    const sheets = pdf.toString('latin1').match(/\/Type\s*\/Page\b(?!s)/g).length;
    if (sheets > Math.ceil(PAGES.length / 2) + more) wrong.push(`${sheets} sheets${query}`);
    const given = { input: pdf, maxBuffer: 1 << 26 };
    const { stdout, error } = spawnSync('pdftotext', ['-', '-'], given);
    const text = error ? '' : squeezed(stdout.toString());
    const topics = await tab.run('lists.pages.map((page) => page[1])');
    const asks = query ? 'Notesforwhoeverpresentsit' : 'Answers';
    if (!error && !text.includes(asks)) wrong.push(`no ${asks}`);
    if (!error) wrong.push(...topics.filter((topic) => !text.includes(squeezed(topic))));
    // No element is cut or has a scroll bar on a sheet, which is 188 mm wide.
    await tab.ask('Emulation.setEmulatedMedia', { media: 'print' });
    await tab.ask('Emulation.setDeviceMetricsOverride', SHEET);
    const cut = `[...document.querySelectorAll('#handout :is(section, .pictures, .cells)')]
      .filter((e) => e.scrollWidth > e.clientWidth ||
        (e.scrollHeight > e.clientHeight && getComputedStyle(e).overflowY !== 'visible'))
      .map((e) => 'cut: ' + e.className + e.textContent.slice(0, 40))`;
    wrong.push(...(await tab.run(cut)));
    wrong.push(...tab.trouble);
    await tab.close();
  }
  verdict('print_gives_two_pages_a_sheet_and_answers_on_two', wrong);
};

const serious = async (browser) => {
  if (!axe || !fs.existsSync(axe))
    return console.error('NOT CHECKED: axe_finds_nothing_serious, as npm has not fetched axe-core');
  const tab = await browser.open(at(''));
  const wrong = [];
  await tab.run(fs.readFileSync(axe, 'utf8') + '; 0');
  for (const name of PAGES) {
    await turnTo(tab, name);
    for (const told of [false, true]) {
      if (told) await answer(tab);
      const found = await tab.run(`axe.run().then(({ violations }) => violations
        .filter(({ impact }) => /serious|critical/.test(impact))
        .map(({ id, nodes }) => id + ' ' + nodes[0].html.slice(0, 90)))`);
      wrong.push(...found.map((what) => `${name}: ${what}`));
    }
  }
  verdict('axe_finds_nothing_serious', [...new Set(wrong)]);
  await tab.close();
};

const inFirefox = async () => {
  if (spawnSync('firefox-esr', ['--version']).error)
    return console.log('skipped Firefox: it is not there');
  const browser = await firefox.launch();
  try {
    const tab = await browser.open(at(''));
    const wrong = [];
    for (const size of ['500x800', '1366x768'])
      wrong.push(...(await nothingIsCut(tab, size, browser.resize)));
    verdict('nothing_is_cut_in_two_sizes_in_Firefox', wrong);
  } finally {
    await browser.close();
  }
};

finish(async () => {
  const only = process.env.ONLY;
  const checks = { sizes, tourByKeys, answers, keysOfBrowser, history, frames, print, serious };
  if (!only || only === 'firefox') await inFirefox();
  const browser = await launch();
  try {
    for (const [name, check] of Object.entries(checks))
      if (!only || only === name) await check(browser);
  } finally {
    await browser.close();
  }
});
