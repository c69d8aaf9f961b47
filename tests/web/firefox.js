// firefox.js - Firefox by its protocol Marionette: JSON after its length, through a
// socket.
'use strict';
const { spawn, spawnSync } = require('child_process');
const fs = require('fs');
const net = require('net');
const os = require('os');
const path = require('path');
const { sleep, untilIn } = require('./browser.js');

const launch = async () => {
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'elasto-web-'));
  const port = path.join(profile, 'MarionetteActivePort');
  fs.writeFileSync(path.join(profile, 'user.js'), 'user_pref("marionette.port", 0);');
  const flags = ['--headless', '--marionette', '--profile', profile];
  const firefox = spawn(process.env.FIREFOX || 'firefox-esr', flags, { stdio: 'ignore' });
  const written = () => fs.existsSync(port) && Number(fs.readFileSync(port, 'utf8'));
  for (let tries = 0; !written() && tries < 3000; tries++) await sleep(100);
  const socket = net.connect(written(), '127.0.0.1');

  const waiting = new Map();
  let rest = Buffer.alloc(0);
  socket.on('data', (data) => {
    rest = Buffer.concat([rest, data]);
    for (;;) {
      const colon = rest.indexOf(':');
      const end = colon + 1 + Number(rest.subarray(0, Math.max(colon, 0)));
      if (colon < 0 || rest.length < end) return;
      const message = JSON.parse(rest.subarray(colon + 1, end)); // the first message is a greeting
      const [, number, error, result] = [].concat(message);
      rest = rest.subarray(end);
      const { done, fail } = waiting.get(number) || {};
      if (error) fail(new Error(error.message));
      else done?.(result);
    }
  });
  let number = 0;
  const ask = (name, params = {}) =>
    new Promise((done, fail) => {
      waiting.set(++number, { done, fail });
      const message = JSON.stringify([0, number, name, params]);
      socket.write(`${Buffer.byteLength(message)}:${message}`);
    });
  await ask('WebDriver:NewSession');

  // Firefox's only tab.  A script that fails gives no answer.
  const open = async (url) => {
    const tab = { trouble: [], url };
    await ask('WebDriver:Navigate', { url });
    tab.run = async (expression) => {
      const how = { script: 'return window.eval(arguments[0])', args: [expression] };
      return (await ask('WebDriver:ExecuteScript', how)).value;
    };
    tab.until = untilIn(tab);
    await tab.until('typeof stats !== "undefined" && (stats.first > 0 || $("said").textContent)');
    return tab;
  };
  // Gives the page this size; the window's frame comes on top of it.
  const resize = async (width, height) => {
    const script = 'return [outerWidth - innerWidth, outerHeight - innerHeight]';
    const { value } = await ask('WebDriver:ExecuteScript', { script, args: [] });
    const size = { width: width + value[0], height: height + value[1] };
    await ask('WebDriver:SetWindowRect', size);
  };
  const close = async () => {
    const gone = new Promise((done) => firefox.once('exit', done));
    await ask('Marionette:Quit', { flags: ['eForceQuit'] }).catch(() => {});
    await gone;
    spawnSync('rm', ['-rf', profile]);
  };
  return { open, close, resize };
};

module.exports = { launch };
