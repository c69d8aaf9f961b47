// check_web.js ELASTO PAGE: checks that the page does what the program does.  Every
// scene and page of the tour ends in the same hash and has the same pixels.  The
// program plays sessions by mouse, keys and touch again.  Files, addresses, bad
// input.  Prints ok or not ok for each promise.
'use strict';
const { spawnSync } = require('child_process');
const crypto = require('crypto');
const fs = require('fs');
const os = require('os');
const path = require('path');
const { launch, sleep, verdict, finish } = require('./browser.js');
const firefox = require('./firefox.js');

const [elasto, page] = process.argv.slice(2).map((name) => path.resolve(name));
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'elasto-check-'));
const at = (line) => `file://${page}#${line.replace(/ /g, '+')}`;
const native = (line, more = {}) =>
  spawnSync(elasto, line.split(' '), { encoding: 'utf8', cwd: folder, ...more });
const hashIn = (text) => (/state(?: hash)? +([0-9a-f]{16})/.exec(text) || [])[1];

// Runs a command line without a window in an open tab and returns its summary.
const headless = async (tab, line) => {
  await tab.run(`$('summary').textContent = $('said').textContent = '';
    location.hash = ${JSON.stringify(at(line).split('#')[1])}`);
  await tab.until(`/state hash/.test($('summary').textContent) || $('said').textContent`);
  return tab.run(`$('summary').textContent || $('said').textContent`);
};

const rows = (line) => native(line).stdout.trim().split('\n');
const word = (row, i) => row.trim().split(/\s+/)[i];
const SCENES = rows('--list').map((row) => word(row, 0));
const PAGES = rows('--list --lecture').map((row) => '--lecture ' + word(row, 1));

const sameHashes = async (browser, name = 'Chromium') => {
  const tab = await browser.open(at('square --headless --steps 0'));
  const wrong = [];
  for (const what of [...SCENES, ...PAGES]) {
    const line = what + ' --headless --steps 20';
    const { stdout, stderr } = native(line);
    const theirs = await headless(tab, line);
    const same = hashIn(stdout) ? hashIn(stdout) === hashIn(theirs) : stderr.trim() === theirs;
    if (!same) wrong.push(`${what}: ${stdout}${stderr}, the page ${theirs}`);
  }
  verdict(`every_scene_and_page_ends_in_the_same_hash_in_${name}`, [...wrong, ...tab.trouble]);
};

// Opens a tab whose downloads wait in `files`.
const CATCH = `window.files = {}; HTMLAnchorElement.prototype.click = function () {
  files[this.download] = fetch(this.href).then((file) => file.blob());
}`;

const digest = (bytes) => crypto.createHash('sha256').update(bytes).digest('hex');
const downloaded = (tab, name) =>
  tab.run(`files['${name}']?.then(async (file) => {
    const digest = await crypto.subtle.digest('SHA-256', await file.arrayBuffer());
    return [...new Uint8Array(digest)].map((n) => n.toString(16).padStart(2, '0')).join('');
  })`);

// Checks the pixels of the canvas at 1x and 2x, without the race, which shows run times.
const samePixels = async (browser) => {
  const tab = await browser.open(at('square --headless --steps 0'), { before: CATCH });
  const wrong = [];
  const all = [...SCENES, ...PAGES].filter((name) => !/race|order/.test(name));
  for (const [i, what] of all.entries())
    for (const size of i % 4 ? ['1280x800'] : ['1280x800', '2560x1600']) {
      const line = `${what} --headless --steps 1 --size ${size} --frames frames`;
      native(line);
      await headless(tab, line);
      const ours = fs.readFileSync(path.join(folder, 'frames/frame_000001.png'));
      if (digest(ours) !== (await downloaded(tab, 'frame_000001.png')))
        wrong.push(`${what} ${size}`);
    }
  verdict('every_scene_and_page_has_the_same_pixels', [...wrong, ...tab.trouble]);
};

// Checks tables, and a run that begins at the last step of a dropped table.
const sameTables = async (browser) => {
  const tab = await browser.open(at('square --headless --steps 0'), { before: CATCH });
  const wrong = [];
  const line = 'tear --headless --steps 3 --states s.csv --energies e.csv --springs p.csv';
  const names = ['s.csv', 'e.csv', 'p.csv'];
  native(line);
  await headless(tab, line);
  for (const name of names) {
    const ours = digest(fs.readFileSync(path.join(folder, name)));
    if (ours !== (await downloaded(tab, path.basename(name)))) wrong.push(name);
  }
  await tab.run(`$('summary').textContent = ''`);
  await drop(tab, 's.csv', fs.readFileSync(path.join(folder, 's.csv'), 'utf8'));
  await tab.until(`files['s.csv'] && /state hash/.test($('summary').textContent)`);
  const theirs = hashIn(await tab.run(`$('summary').textContent`));
  const ours = hashIn(native('tear --headless --steps 3 --state s.csv').stdout);
  if (ours !== theirs) wrong.push(`from a table: ${theirs}, not ${ours}`);
  verdict('tables_are_the_same_and_begin_a_run', [...wrong, ...tab.trouble]);
};

// Ends a session with Y, which shows a hash and downloads a script, and checks that
// the script leads the program to this hash.  A long touch waits for `patience`.
const TOUCH = `const later = setTimeout; var patience = 500;
  setTimeout = (deed, ms) => later(deed, ms === 500 ? patience : ms);`;
// Returns the message of the last command, and the method.
const SAID = `now.told[0][1] + ' ' + now.time`;
// Waits for ten more frames.
const more = async (tab) => tab.until(`stats.frames > ${await tab.run('stats.frames')} + 9`);
const SESSIONS = {
  mouse: async (tab, x, y) => {
    await tab.mouse('mousePressed', x, y, { button: 'right' });
    await tab.mouse('mouseReleased', x, y, { button: 'right' });
    await tab.mouse('mousePressed', x + 50, y - 50);
    for (let i = 1; i <= 6; i++) await tab.mouse('mouseMoved', x + 50 + 20 * i, y - 50 - 10 * i);
    await more(tab);
    await tab.mouse('mouseReleased', x + 180, y - 120);
    await tab.key('Space');
    await tab.mouse('mouseWheel', x, y, { deltaX: 0, deltaY: -200 });
    await tab.key('n');
  },
  keys: async (tab) => {
    const keys =
      'Space n n i i ArrowRight ArrowRight Escape p n | 0 . 0 2 Enter * n m n ArrowLeft n';
    for (const key of keys.split(' '))
      if (key === '|') await tab.run(`document.querySelector('[name=timestep]').select()`);
      else if (key === '*') await tab.run('canvas.focus()');
      else await tab.key(key);
  },
  touch: async (tab, x, y) => {
    await tab.key('Space');
    await tab.touch('touchStart', [x, y]);
    await tab.until(`/pinned/.test(${SAID})`);
    await tab.run('patience = 1e6'); // no touch is a long one now, however late it moves
    await tab.touch('touchEnd');
    await tab.key('Space');
    await tab.touch('touchStart', [x + 50, y - 50]);
    for (let i = 1; i <= 6; i++) await tab.touch('touchMove', [x + 50 + 20 * i, y - 50 - 10 * i]);
    await more(tab);
    await tab.touch('touchEnd');
    await tab.key('Space');
    await tab.touch('touchStart', [x - 50, y], [x + 50, y]);
    await tab.touch('touchMove', [x - 80, y], [x + 80, y]);
    await tab.touch('touchEnd');
    await tab.key('n');
  },
};
const SQUARE = 'square --segments 12';

const sessions = async (browser) => {
  for (const [name, session] of Object.entries(SESSIONS)) {
    const downloads = path.join(folder, name);
    fs.mkdirSync(downloads);
    const tab = await browser.open(at(SQUARE), { before: TOUCH });
    await tab.downloads(downloads);
    await more(tab);
    const [x, y] = await tab.run('[canvas.clientWidth / 2, canvas.clientHeight / 2]');
    await session(tab, x, y);
    await tab.key('y');
    await tab.until(`/state [0-9a-f]{16}/.test(${SAID})`);
    const text = await tab.run(SAID);
    const arrived = () => fs.readdirSync(downloads).find((file) => /script$/.test(file));
    for (let tries = 0; !arrived() && tries < 3000; tries++) await sleep(100);
    const script = arrived();
    const wrong = [...tab.trouble];
    if (!script) wrong.push('no script arrived: ' + text);
    else {
      const file = path.join(downloads, script);
      const played = native(`${SQUARE} --headless --script ${file}`);
      if (!hashIn(text) || hashIn(text) !== hashIn(played.stdout) || played.stderr)
        wrong.push(`${text}, the program ${hashIn(played.stdout)} ${played.stderr}`);
      for (const deed of name === 'keys' ? [] : [/grab|drag/, /pin/])
        if (!deed.test(fs.readFileSync(file, 'utf8'))) wrong.push(`no ${deed}`);
      if (name === 'mouse') await dropped(browser, SQUARE, file, hashIn(text));
    }
    verdict(`a_session_by_${name}_is_the_programs`, wrong);
  }
};

// Drops a file with this text on the page.
const drop = (tab, name, text) =>
  tab.run(`(() => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([${JSON.stringify(text)}], '${name}'));
    dispatchEvent(new DragEvent('drop', { dataTransfer, cancelable: true }));
  })()`);

const dropped = async (browser, scene, file, hash) => {
  const tab = await browser.open(at(scene + ' --headless --steps 0'));
  const wrong = [];
  await tab.run(`line = ${JSON.stringify((scene + ' --headless').split(' '))}`);
  await drop(tab, 'mine.script', fs.readFileSync(file, 'utf8'));
  const summary = `$('summary').textContent`;
  await tab.until(`/state hash/.test(${summary}) && !/steps +0\\n/.test(${summary})`);
  const text = await tab.run(summary);
  if (hashIn(text) !== hash) wrong.push(`${hashIn(text)} for ${hash}`);
  verdict(`the_dropped_${path.basename(file)}_is_played`, [...wrong, ...tab.trouble]);
};

// Twenty seconds of pushing, pressing and throwing end in the program's hash.
const pushed = async (browser) => {
  const file = path.join(__dirname, '../data/push.script');
  const told = (word) =>
    new RegExp(`^# ${word}: (.*)$`, 'm').exec(fs.readFileSync(file, 'utf8'))[1];
  await dropped(browser, told('line'), file, told('ends'));
};

// The saved picture has the pixels of the canvas, also at 2x.
const saved = async (browser) => {
  const wrong = [];
  for (const ratio of [1, 2]) {
    const screen = { width: 800, height: 500, ratio, before: CATCH };
    const tab = await browser.open(at('hang --paused'), screen);
    const frames = await tab.run('stats.frames');
    await tab.key('0'); // the first key removes the greeting
    await tab.until(`stats.frames > ${frames}`);
    await tab.run(`paper = canvas.getContext('2d');
      ours = paper.getImageData(0, 0, canvas.width, canvas.height).data`);
    await tab.key('s');
    await tab.until(`Object.keys(files).length === 1`);
    const same = await tab.run(`Object.values(files)[0].then(createImageBitmap).then((picture) => {
      const copy = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
      copy.drawImage(picture, 0, 0);
      const theirs = copy.getImageData(0, 0, picture.width, picture.height).data;
      return ${ratio} * canvas.clientWidth === picture.width && ours.every((n, i) => n === theirs[i]);
    })`);
    if (!same) wrong.push(ratio + 'x');
    wrong.push(...tab.trouble);
    await tab.close();
  }
  verdict('a_saved_picture_has_the_pixels_of_the_canvas', wrong);
};

const addresses = async (browser) => {
  const wrong = [];
  const tab = await browser.open(at(''));
  const follows = async (key, expected) => {
    if (key) await tab.key(key);
    await tab
      .until(`location.hash === '#${expected}'`, 60000)
      .catch(async () => wrong.push(`${key}: ${await tab.run('location.hash')}, not #${expected}`));
  };
  await follows('', PAGES[0].replace(' ', '+').replace(/\+.*/, ''));
  await follows('PageDown', PAGES[1].replace(' ', '+'));
  await follows('7', PAGES[1].replace(' ', '+')); // a guess
  await tab.key('Enter');
  await tab.until(`field('verdict')`);
  await tab.run(`canvas.focus(), (location.hash = 'square')`);
  await follows('', 'square');
  await follows('7', SCENES[6]);
  // A timer may ask for the texts before the first frame of a session.
  await tab.run(`begin(['overshoot']); showDocument(performance.now() + 1e6)`);
  await follows('', 'overshoot');
  await tab.run(`location.hash = 'circle+--timestep+0.05&bare'`);
  await follows('', 'circle+--timestep+0.05&bare');
  if (!(await tab.run('document.body.classList.contains("bare")'))) wrong.push('not bare');
  // A value may have blanks, a number a +, and a % may stand for itself.
  for (const [given, written] of [
    ['square+--timestep+8%20ms', 'square+--timestep+8%20ms'],
    ['square+--stiffness+1e+6', 'square+--stiffness+1e%2B6'],
    ['square+--stretch+7%', 'square+--stretch+7%25'],
  ]) {
    await tab.run(`location.hash = '${given}'`);
    await follows('', written);
  }
  await tab.run(`heard = ''; new MutationObserver(() => (heard += $('said').textContent))
    .observe($('said'), { childList: true })`); // the message vanishes after a while
  await tab.key('y');
  await tab
    .until(`/link .* copied/.test(heard)`, 60000)
    .catch(() => wrong.push('Y copies no link'));
  verdict('the_address_follows_what_is_shown', [...wrong, ...tab.trouble]);

  // A bad line shows the program's message, and the present run goes on.
  const bad = [];
  await tab.run(`$('said').textContent = ''; location.hash = 'square+--segments+0'`);
  await tab.until(`$('said').textContent`);
  const ours = native('square --segments 0').stderr.trim();
  const theirs = await tab.run(`$('said').textContent`);
  if (ours !== theirs) bad.push(`'${theirs}', not '${ours}'`);
  await drop(tab, 'x.script', '3 no such command\n');
  await tab
    .until(`/no command/.test($('said').textContent)`, 60000)
    .catch(() => bad.push('the bad script is not named'));
  const frames = await tab.run('stats.frames');
  await tab.key('Space');
  await tab.until(`stats.frames > ${frames}`, 60000).catch(() => bad.push('nothing goes on'));
  verdict('bad_lines_and_scripts_are_one_sentence', bad);
};

// Checks that the memory of a page does not grow with its steps.
const memory = async (browser) => {
  const sizes = [];
  for (const steps of [1000, 10000]) {
    const tab = await browser.open(at(`square --segments 16 --speed 1000 --steps ${steps}`));
    await tab.until(`/state hash/.test($('summary').textContent)`);
    sizes.push(await tab.run('Module.asm.memory.buffer.byteLength'));
    await tab.close();
  }
  verdict('memory_does_not_grow', sizes[0] === sizes[1] ? [] : [`${sizes} bytes`]);
};

// Checks browsers without a needed feature, and hidden tabs.
const lacking = async (browser) => {
  const wrong = [];
  // A tab with 64 MB.
  const full = `const grow = WebAssembly.Memory.prototype.grow;
    WebAssembly.Memory.prototype.grow = function (pages) {
      if (this.buffer.byteLength + 65536 * pages > 64 * 2 ** 20) throw new RangeError('no');
      return grow.call(this, pages);
    }`;
  const shown = async (before, line, expression, expected) => {
    const tab = await browser.open(at('circle'), { before });
    await tab.run(`location.hash = ${JSON.stringify(line)}`);
    const found = `${expression}.includes('${expected}')`;
    await tab.until(found, 60000).catch(() => wrong.push(expected));
    const frames = await tab.run('stats.frames');
    if (before === full)
      await tab.until(`stats.frames > ${frames}`, 60000).catch(() => wrong.push('nothing goes on'));
    await tab.close();
  };
  const said = `$('said').textContent`;
  await shown('WebAssembly.validate = () => false', '', said, 'WebAssembly SIMD');
  await shown(full, 'square+--segments+400', said, 'not enough memory');
  const text = `(field('time'))`;
  await shown('window.matchMedia = () => ({ matches: true })', 'hang', text, 'paused');
  await shown('', 'hang', text, 'running');
  verdict('what_a_browser_lacks_is_said_and_it_goes_on', wrong);

  const tab = await browser.open(at('square'), {
    before: `Object.defineProperty(document, 'hidden', { get: () => window.away })`,
  });
  await tab.until('stats.frames > 5');
  await tab.run(`away = true; document.dispatchEvent(new Event('visibilitychange'))`);
  const frames = await tab.run('stats.frames');
  await sleep(700);
  const after = await tab.run('stats.frames');
  await tab.run(`away = false; document.dispatchEvent(new Event('visibilitychange'))`);
  await tab.until(`stats.frames > ${after}`, 60000).catch(() => {});
  const back = await tab.run('stats.frames');
  const stops = after === frames && back > after;
  verdict('a_tab_in_the_background_stops', stops ? [] : [`${frames}, ${after}, ${back} frames`]);

  // A paused run draws no frame and writes no text.
  await tab.run(`wake(ask('web_obey_script', null, 'pause'))`);
  await tab.until(`field('step', 2) === '1' && !drawn`);
  await sleep(700);
  const still = await tab.run('stats.frames');
  await tab.run(`changes = 0; new MutationObserver((all) => (changes += all.length)).observe(
    document.body, { subtree: true, childList: true, attributes: true, characterData: true })`);
  await sleep(700);
  const more = (await tab.run('stats.frames')) - still;
  const changes = await tab.run('changes');
  const busy = more || changes ? [`${more} frames, ${changes} changes`] : [];
  verdict('a_paused_page_makes_no_frame_and_writes_nothing', busy);
};

finish(async () => {
  const size = fs.statSync(page).size;
  verdict('the_page_has_at_most_1100_kB', size <= 1.1e6 ? [] : [`${size} bytes`]);
  if (spawnSync('firefox-esr', ['--version']).error)
    console.log('skipped Firefox: it is not there');
  else {
    const browser = await firefox.launch();
    await sameHashes(browser, 'Firefox').finally(browser.close);
  }
  const browser = await launch();
  try {
    const quick = [addresses, sessions, pushed, saved, sameTables, memory, lacking];
    for (const check of [...quick, sameHashes, samePixels]) await check(browser);
  } finally {
    await browser.close();
    fs.rmSync(folder, { recursive: true, force: true });
  }
});
