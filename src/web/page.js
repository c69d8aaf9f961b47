// page.js - canvas, mouse, touch, keys, files and address of the page, for the
// program behind window_web.c and main_web.c.

const $ = (id) => document.getElementById(id);
const canvas = $('canvas');
let Module, FS; // the program, and its files

const ask = (name, type, ...values) => {
  const types = values.map((value) => typeof value);
  return Module.ccall(name, type, types, values);
};

// Time of the first frame, ms, and number of frames: tests wait for them.
const stats = { first: 0, frames: 0 };

// Shows a line below the page; good news (fine) vanishes after three seconds.
let silence = 0; // timer
const say = (text, fine) => {
  $('loading').hidden = true;
  $('said').textContent = text;
  $('said').className = fine ? 'fine' : '';
  clearTimeout(silence);
  if (fine) silence = setTimeout(() => ($('said').textContent = ''), 3000);
};

// ---- what the program calls -------------------------------------------------

const pixels = (length) => Math.max(1, Math.round(length * devicePixelRatio));
const Page = {
  width: () => pixels(canvas.clientWidth),
  height: () => pixels(canvas.clientHeight),
  letter: () => (sheet ? 26 : pixels(parseFloat(getComputedStyle(canvas).fontSize))),
  hasDocument: () => !bare,
  // Shows pixels at an address of the heap: the picture (card -1) or a card.
  show(heap, at, width, height, card) {
    const target = sheet?.canvas ?? (card < 0 ? canvas : $('graph' + card));
    drawn ||= card < 0;
    if (target.width !== width || target.height !== height)
      [target.width, target.height] = [width, height];
    const bytes = new Uint8ClampedArray(heap.buffer, at, 4 * width * height);
    const image = new ImageData(bytes, width, height);
    target.getContext('2d', { alpha: false }).putImageData(image, 0, 0);
  },
};

// ---- files ------------------------------------------------------------------

// Hands complete files of the program's folder out as downloads and removes them.
const OUT = '/out';
const download = (folder = OUT) => {
  for (const name of FS.readdir(folder)) {
    const path = `${folder}/${name}`;
    if (name[0] === '.' || /\.part\d*$/.test(name)) continue;
    if (FS.isDir(FS.stat(path).mode)) download(path);
    else {
      const href = URL.createObjectURL(new Blob([FS.readFile(path)]));
      make('a', [], { href, download: name }).click();
      setTimeout(() => URL.revokeObjectURL(href), 60000);
      FS.unlink(path);
    }
  }
};

// A dropped script is played; a dropped table gives the state that a run begins with.
addEventListener('dragover', (event) => event.preventDefault());
addEventListener('drop', async (event) => {
  event.preventDefault();
  const file = event.dataTransfer.files[0];
  if (!file) return;
  const name = '/' + file.name.replace(/[^\w.-]/g, '_');
  FS.writeFile(name, new Uint8Array(await file.arrayBuffer()));
  const option = /\.csv$/i.test(name) ? '--state' : '--script';
  begin([...line.filter((word, i) => word !== option && line[i - 1] !== option), option, name]);
});

// ---- the address ------------------------------------------------------------

// #circle+--timestep+0.05&bare stands for a command line: + is a blank (not in
// 1e+6), %20 is the sign with this code (a % without a code is itself), and &bare
// shows the picture alone.
let line = []; // words of the command line that runs
let bare = false;
let shown = ''; // the last address that was read or written
let entry = null; // page of the newest entry of the history; null: not known yet
let looking = 0; // timer of the next updateAddress, or 0
const decode = (word) => new URLSearchParams('=' + word.replace(/\+/g, '%2B')).get('');
const readAddress = () => {
  shown = location.hash;
  const [text, mark] = location.hash.slice(1).split('&');
  const words = text.split(/(?<!\de)\+/i).filter(Boolean);
  bare = mark === 'bare';
  return words.length ? words.map(decode) : ['--lecture'];
};

// Writes scene, page and changed numbers into the address.  Another page of the
// tour is a new entry of the history, so that Back leads to the page before.
const updateAddress = () => {
  looking = 0;
  if (location.hash !== shown) return; // a new address was not read yet
  const words = ask('web_get_command_line', 'string').split('\n').filter(Boolean);
  const text = words.map((word) => encodeURIComponent(word).replace(/%2C/g, ',')).join('+');
  const address = `#${text}${bare ? '&bare' : ''}`;
  if (!text || address === shown) return;
  shown = address;
  const turns = entry !== null && entry !== field('page', 2);
  entry = field('page', 2);
  history[turns ? 'pushState' : 'replaceState'](null, '', shown);
};
addEventListener('hashchange', () => location.hash !== shown && begin(readAddress()));

// ---- the loop ---------------------------------------------------------------

let timer = 0; // of the next frame, if no frame is due now
let asked = 0; // request for the next frame, or 0
let drawn = false; // the picture was drawn after texts and cards were shown
const frame = () => {
  asked = 0;
  if (document.hidden && !canvas.hidden) return;
  const start = performance.now();
  const wait = Module._web_make_frame(); // ms until the next frame is due
  stats.frames++;
  download();
  if (wait < 0) {
    const more = canvas.hidden || $('said').textContent;
    return more || say('The end. Reload the page to begin again.', true);
  }
  if (drawn && !canvas.hidden) looking ||= setTimeout(updateAddress, 500);
  if (drawn) showDocument(start);
  if (canvas.hidden) timer = setTimeout(frame, 0);
  else if (wait <= 20) asked = requestAnimationFrame(frame);
  else if (wait < 2 ** 31 - 1) timer = setTimeout(wake, wait); // else an input wakes it
};
const wake = () => {
  clearTimeout(timer);
  if (!asked && !document.hidden) asked = requestAnimationFrame(frame);
};
document.addEventListener('visibilitychange', wake);

const begin = (words) => {
  $('said').textContent = $('summary').textContent = '';
  const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const still = calm && !words.some((word) => /^--(paused|steps|script|headless)/.test(word));
  const code = ask('web_begin_session', 'number', [...words, still ? '--paused' : ''].join('\n'));
  download();
  if (code > 0 && !line.length && words.join() !== '--lecture') {
    const why = $('said').textContent; // a wrong address shows the tour, and why
    begin(['--lecture']);
    return say(why);
  }
  if (code >= 0) {
    bare = document.body.classList.contains('bare'); // the shown run goes on
    return;
  }
  line = words;
  entry = null;
  canvas.hidden = words.includes('--headless');
  document.body.classList.toggle('bare', bare);
  clearTimeout(timer);
  canvas.hidden ? frame() : wake();
};

// ---- keys -------------------------------------------------------------------

const key = (name, repeats = false) => FS && wake(ask('web_queue_key', null, name, repeats));

// Returns the name of a key in window.h, also on keyboards without Latin letters; ''
// for a key without a name there, and for Escape, which does nothing in a page.
const NAMED = /^(Arrow\w+|Page\w+|Home|End|Enter|Backspace|Delete|.)$/;
const nameOf = ({ key, code }) => {
  if (/^[a-z]$/i.test(key)) return key.toUpperCase();
  if (key.length === 1 && key > '\x7f' && /^Key[A-Z]$/.test(code)) return code[3];
  if (!NAMED.test(key)) return '';
  return key.replace('Arrow', '').replace('Enter', 'Return').replace(' ', 'Space');
};

// Keys with a modifier and function keys are left to the browser; Q does nothing.
// FOLDS has keys whose list the document shows.
const FOLDS = { K: 'code', 'Shift+G': 'pages', G: 'scenes', A: 'more', '?': 'keys' };
canvas.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.isComposing) return;
  const name = nameOf(event);
  const whole = (event.shiftKey && /^\w{2}|^[A-Z]$/.test(name) ? 'Shift+' : '') + name;
  if (field('asks') === 'number' && /^[\d.,+-]$/.test(name)) return $('answer').focus();
  if (!name || name === 'Q') return;
  event.preventDefault();
  if (FOLDS[whole]) return openPart(FOLDS[whole]);
  key(whole, event.repeat);
  if (whole !== 'Y') return;
  updateAddress();
  const copied = navigator.clipboard?.writeText(location.href);
  copied?.then(() => say('The link to this is copied.', true)).catch(() => {});
});
canvas.addEventListener('blur', () => last.clicks && tell(RELEASE, last)); // a drag ends

// ---- mouse, pen and fingers -------------------------------------------------

// InputKind and buttons of window.h; a button is one more than the browser's.
const [REDRAW, MOVE, PRESS, RELEASE, WHEEL, LEAVE] = [3, 4, 5, 6, 7, 8];
const [LEFT, MIDDLE, RIGHT] = [1, 2, 3];
const LONG_TOUCH = 500; // ms
const ZOOM = 1.15; // factor of one notch of the wheel
const STILL = 8; // CSS pixels; a finger that moves less touches one place

const tell = (kind, at, button = 0, clicks = 1, amount = 0) => {
  if (!FS) return;
  const { left, top } = canvas.getBoundingClientRect();
  const [x, y] = [at.clientX - left, at.clientY - top].map((n) => n * devicePixelRatio);
  Module._web_queue_mouse(kind, x, y, button, clicks, amount);
  wake();
};

let last = { timeStamp: -1e9, clicks: 0 };
const near = (a, b) => Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) < STILL;
const press = (event, button) => {
  const again = event.timeStamp - last.timeStamp < 500 && button === last.button;
  const { timeStamp, clientX, clientY } = event;
  const clicks = again && near(event, last) ? last.clicks + 1 : 1;
  last = { timeStamp, clientX, clientY, button, clicks };
  tell(MOVE, event);
  tell(PRESS, event, button, clicks);
};

// One finger is the left button when it moves or is lifted, the right one after a
// long touch; two fingers move and zoom the picture.
const fingers = new Map(); // pointerId -> event
let touch = null; // {first event, pressed: LEFT, MIDDLE or 0, timer of a long touch}
const findCentre = () => {
  const [a, b] = [...fingers.values()];
  return {
    clientX: (a.clientX + b.clientX) / 2,
    clientY: (a.clientY + b.clientY) / 2,
    wide: Math.max(1, Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY)),
  };
};
const touchDown = (event) => {
  fingers.set(event.pointerId, event);
  clearTimeout(touch?.timer);
  if (fingers.size === 1) {
    const pin = () => {
      press(event, RIGHT);
      tell(RELEASE, event, RIGHT);
      touch = null;
    };
    touch = { first: event, pressed: 0, timer: setTimeout(pin, LONG_TOUCH) };
  } else if (fingers.size === 2 && touch) {
    if (touch.pressed) tell(RELEASE, event, touch.pressed);
    touch.pressed = MIDDLE;
    touch.at = findCentre();
    press({ timeStamp: event.timeStamp, ...touch.at }, MIDDLE);
  }
};
const touchMove = (event) => {
  fingers.set(event.pointerId, event);
  if (!touch) return;
  if (touch.pressed === MIDDLE && fingers.size === 2) {
    const now = findCentre();
    tell(MOVE, now);
    tell(WHEEL, now, 0, 1, Math.log(now.wide / touch.at.wide) / Math.log(ZOOM));
    touch.at = now;
  }
  if (!touch.pressed && !near(event, touch.first)) {
    clearTimeout(touch.timer);
    if (bare && document.activeElement !== canvas) return (touch = null); // it scrolls
    touch.pressed = LEFT;
    press(touch.first, LEFT);
  }
  if (touch.pressed === LEFT) tell(MOVE, event);
};
const touchUp = (event) => {
  fingers.delete(event.pointerId);
  if (event.type === 'pointerup') canvas.focus({ preventScroll: true });
  if (!touch) return;
  clearTimeout(touch.timer);
  if (!touch.pressed && event.type === 'pointerup') {
    press(touch.first, LEFT);
    touch.pressed = LEFT;
  }
  if (touch.pressed) tell(RELEASE, event, touch.pressed);
  touch = null;
};

const isTouch = (event) => event.pointerType === 'touch';
canvas.onpointerdown = (event) => {
  canvas.setPointerCapture(event.pointerId);
  event.preventDefault();
  if (isTouch(event)) return touchDown(event); // a finger may scroll
  canvas.focus({ preventScroll: true });
  press(event, event.button + 1);
};
canvas.onpointermove = (event) => (isTouch(event) ? touchMove(event) : tell(MOVE, event));
canvas.onpointerup = canvas.onpointercancel = (event) =>
  isTouch(event) ? touchUp(event) : tell(RELEASE, event, event.button + 1);
canvas.onpointerleave = (event) => tell(LEAVE, event);
canvas.oncontextmenu = (event) => event.preventDefault();
canvas.onwheel = (event) => {
  if (event.ctrlKey || document.activeElement !== canvas) return; // the page scrolls
  tell(WHEEL, event, 0, 1, -event.deltaY / (event.deltaMode ? 1 : 100));
  event.preventDefault();
};

// ---- the beginning ----------------------------------------------------------

const unpack = async (id) => {
  const { body } = await fetch('data:;base64,' + $(id).textContent);
  return new Response(body.pipeThrough(new DecompressionStream('gzip')));
};

$('licences').onclick = async () => {
  $('licence').textContent = await (await unpack('packed-licences')).text();
  $('notice').showModal();
};

// A WebAssembly module with a function that returns a vector of 16 zeros.
const SIMD = atob('AGFzbQEAAAABBQFgAAF7AwIBAAoIAQYAQQD9Dws=');

const failed = (error) => {
  const why = /memory/i.test(error) ? 'there is not enough memory' : error.message || error;
  say(`elasto: ${why}; reload the page.`);
};
addEventListener('error', (event) => failed(event.error || event.message));
addEventListener('unhandledrejection', (event) => failed(event.reason));

// Called by the last script of the page.
const start = async () => {
  const bytes = Uint8Array.from(SIMD, (letter) => letter.charCodeAt(0));
  if (!window.DecompressionStream || !window.WebAssembly?.validate(bytes))
    return say('elasto needs WebAssembly SIMD: Chrome 105, Firefox 121, Safari 16.4 or newer.');
  document.body.append(make('script', [$('module').textContent]));
  Module = await createElasto({
    wasmBinary: await (await unpack('packed-program')).arrayBuffer(),
    print: (text) => ($('summary').textContent += text + '\n'),
    printErr: (text) => say(text, !/^(elasto|script):/.test(text)),
  });
  FS = Module.FS;
  FS.mkdir(OUT);
  FS.chdir(OUT);
  $('loading').hidden = true;
  listDocument();
  begin(readAddress());
  if (window === top) canvas.focus({ preventScroll: true });
  stats.first = performance.now();
  new ResizeObserver(() => tell(REDRAW, { clientX: 0, clientY: 0 })).observe(canvas);
  document.body.classList.toggle('notes', /[?&]notes/.test(location.search));
};
