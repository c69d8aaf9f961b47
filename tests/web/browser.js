// browser.js - Chromium by the DevTools protocol through a pipe: tabs with real
// mouse, keys and touch.  No host name resolves.  Requests and errors of a tab are
// kept in a list.
'use strict';
const { spawn, spawnSync } = require('child_process');
const fs = require('fs');
const os = require('os');
const path = require('path');

const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

// Repeats a question until its answer is true, for long on a busy machine.
const untilIn =
  (tab) =>
  async (expression, ms = 300000) => {
    for (const end = Date.now() + ms; Date.now() < end; await sleep(20))
      if (await tab.run(expression)) return;
    throw new Error(`${tab.url}: waited in vain for ${expression}`);
  };

const launch = async () => {
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'elasto-web-'));
  const flags =
    '--headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run ' +
    `--remote-debugging-pipe --user-data-dir=${profile}`;
  const chromium = spawn(
    process.env.CHROMIUM || 'chromium',
    [...flags.split(' '), '--host-resolver-rules=MAP * ~NOTFOUND', 'about:blank'],
    { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] },
  );
  const waiting = new Map();
  const listeners = [];
  chromium.once('exit', () => waiting.forEach(({ fail }) => fail(new Error('Chromium ended'))));
  let number = 0;
  let rest = '';
  chromium.stdio[4].on('data', (data) => {
    const parts = (rest + data).split('\0');
    rest = parts.pop();
    for (const message of parts.map((part) => JSON.parse(part))) {
      const { done, fail } = waiting.get(message.id) || {};
      waiting.delete(message.id);
      if (!done) listeners.forEach((listener) => listener(message));
      else if (message.error) fail(new Error(message.error.message));
      else done(message.result);
    }
  });
  const send = (method, params = {}, sessionId) =>
    new Promise((done, fail) => {
      waiting.set(++number, { done, fail });
      chromium.stdio[3].write(JSON.stringify({ id: number, method, params, sessionId }) + '\0');
    });

  // Opens a tab of this size, whose errors go into `trouble`.
  const open = async (url, { width = 1280, height = 800, ratio = 1, before = '' } = {}) => {
    const { targetId } = await send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await send('Target.attachToTarget', { targetId, flatten: true });
    const tab = { trouble: [], url };
    const ask = (method, params) => send(method, params, sessionId);
    listeners.push(({ method, params, sessionId: from }) => {
      if (from !== sessionId) return;
      if (method === 'Network.requestWillBeSent' && !/^(file|data|blob):/.test(params.request.url))
        tab.trouble.push('request ' + params.request.url);
      if (method === 'Runtime.consoleAPICalled' && params.type !== 'log')
        tab.trouble.push(params.args.map((arg) => arg.value).join(' '));
      if (method === 'Runtime.exceptionThrown')
        tab.trouble.push(params.exceptionDetails.exception?.description || 'exception');
      if (method === 'Log.entryAdded') tab.trouble.push(params.entry.text);
    });
    for (const domain of ['Page', 'Runtime', 'Network', 'Log']) await ask(domain + '.enable');
    const screen = { width, height, deviceScaleFactor: ratio, mobile: false };
    await ask('Emulation.setDeviceMetricsOverride', screen);
    await ask('Emulation.setFocusEmulationEnabled', { enabled: true });
    if (before) await ask('Page.addScriptToEvaluateOnNewDocument', { source: before });
    await ask('Page.navigate', { url });
    tab.ask = ask;
    tab.run = async (expression) => {
      const how = { expression, awaitPromise: true, returnByValue: true };
      const answer = await ask('Runtime.evaluate', how);
      if (answer.exceptionDetails) throw new Error(answer.exceptionDetails.exception.description);
      return answer.result.value;
    };
    tab.until = untilIn(tab);
    tab.mouse = (type, x, y, more = {}) => {
      const button = type === 'mouseMoved' ? 'none' : 'left';
      return ask('Input.dispatchMouseEvent', { type, x, y, button, clickCount: 1, ...more });
    };
    tab.touch = (type, ...places) => {
      const touchPoints = places.map(([x, y], id) => ({ x, y, id }));
      return ask('Input.dispatchTouchEvent', { type, touchPoints });
    };
    tab.key = async (name, modifiers = 0) => {
      const sign = name.length === 1 && !(modifiers & 2) ? name : undefined;
      const text = name === 'Enter' ? '\r' : sign;
      const code = /^[a-z]$/i.test(name) ? 'Key' + name.toUpperCase() : name;
      const key = { key: name === 'Space' ? ' ' : name, code, modifiers };
      await ask('Input.dispatchKeyEvent', { type: 'keyDown', text, ...key });
      await ask('Input.dispatchKeyEvent', { type: 'keyUp', ...key });
    };
    // Returns the printed lecture as a PDF.
    tab.print = async () => {
      await tab.run('printLecture()');
      const { data } = await ask('Page.printToPDF', { preferCSSPageSize: true });
      return Buffer.from(data, 'base64');
    };
    tab.downloads = (folder) =>
      send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: folder });
    tab.close = () => send('Target.closeTarget', { targetId });
    await tab.until('typeof stats !== "undefined" && (stats.first > 0 || $("said").textContent)');
    return tab;
  };
  const close = async () => {
    const gone = new Promise((done) => chromium.once('exit', done));
    await Promise.race([send('Browser.close').catch(() => {}), sleep(5000)]);
    chromium.kill();
    await gone;
    for (let tries = 0; fs.existsSync(profile) && tries < 20; tries++) {
      await sleep(100); // processes of the browser may still write there
      spawnSync('rm', ['-rf', profile]);
    }
  };
  return { open, close };
};

// Prints ok or not ok for a promise, and the reason of a failure.
let failed = 0;
const verdict = (name, wrong) => {
  const most = Number(process.env.MOST || 12);
  console.log(wrong.length ? `not ok ${name}: ${wrong.slice(0, most).join('; ')}` : `ok ${name}`);
  failed += wrong.length > 0;
};

// Runs the checks and exits with 1 if one of them failed.
const finish = (checks) =>
  checks()
    .then(() => process.exit(failed ? 1 : 0))
    .catch((error) => {
      console.log(`not ok ${error.stack}`);
      process.exit(1);
    });

module.exports = { launch, sleep, untilIn, verdict, finish };
