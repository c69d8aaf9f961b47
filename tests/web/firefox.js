// firefox.js - Firefox by WebDriver BiDi: tabs that run what they are told.
'use strict';
const { spawn, spawnSync } = require('child_process');
const crypto = require('crypto');
const fs = require('fs');
const http = require('http');
const os = require('os');
const path = require('path');
const { untilIn } = require('./browser.js');

// A WebSocket of RFC 6455, for texts; a client masks what it sends.
const MASK = 0x55;
const connect = (url, hear) =>
  new Promise((done, fail) => {
    const headers = {
      Connection: 'Upgrade',
      Upgrade: 'websocket',
      'Sec-WebSocket-Version': 13,
      'Sec-WebSocket-Key': crypto.randomBytes(16).toString('base64'),
    };
    const say = (socket, text) => {
      const bytes = Buffer.from(text).map((byte) => byte ^ MASK);
      const long = bytes.length > 125; // then two more bytes tell how long
      const head = Buffer.alloc(long ? 8 : 6, MASK); // it ends with the mask
      head.set([0x81, 0x80 | (long ? 126 : bytes.length)]);
      if (long) head.writeUInt16BE(bytes.length, 2);
      socket.write(Buffer.concat([head, bytes]));
    };
    const listen = (socket) => {
      let [rest, text] = [Buffer.alloc(0), ''];
      socket.on('data', (data) => {
        rest = Buffer.concat([rest, data]);
        for (;;) {
          const short = rest[1] & 127;
          const begin = short < 126 ? 2 : short === 126 ? 4 : 10;
          if (rest.length < begin) return;
          const length =
            short < 126 ? short : short === 126 ? rest.readUInt16BE(2) : rest.readUInt32BE(6);
          if (rest.length < begin + length) return;
          const end = (rest[0] & 15) === 8;
          text += end ? '' : rest.subarray(begin, begin + length);
          if (rest[0] & 128 && text) {
            hear(JSON.parse(text));
            text = '';
          }
          rest = rest.subarray(begin + length);
        }
      });
    };
    http
      .get(url.replace('ws:', 'http:'), { headers })
      .on('upgrade', (answer, socket) => {
        listen(socket);
        done((text) => say(socket, text));
      })
      .on('error', fail);
  });

const launch = async () => {
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'elasto-web-'));
  const flags = ['--headless', '--remote-debugging-port', '0', '--profile', profile];
  const firefox = spawn(process.env.FIREFOX || 'firefox-esr', flags);
  const url = await new Promise((done) =>
    firefox.stderr.on('data', (data) => {
      const found = /listening on (ws:\S+)/.exec(data);
      if (found) done(found[1]);
    }),
  );
  const waiting = new Map();
  const tabs = new Map();
  const send = await connect(url + '/session', (message) => {
    const { done, fail } = waiting.get(message.id) || {};
    if (message.type === 'error') fail(new Error(message.message));
    else if (done) done(message.result);
    else if (message.method === 'log.entryAdded' && message.params.level === 'error')
      tabs.get(message.params.source.context)?.trouble.push(message.params.text);
  });
  let number = 0;
  const ask = (method, params) =>
    new Promise((done, fail) => {
      waiting.set(++number, { done, fail });
      send(JSON.stringify({ id: number, method, params }));
    });
  await ask('session.new', { capabilities: {} });
  await ask('session.subscribe', { events: ['log.entryAdded'] });

  const open = async (url) => {
    const { context } = await ask('browsingContext.create', { type: 'tab' });
    const tab = { trouble: [], url };
    tabs.set(context, tab);
    await ask('browsingContext.navigate', { context, url, wait: 'complete' });
    tab.run = async (expression) => {
      const how = { expression, awaitPromise: true, target: { context } };
      const answer = await ask('script.evaluate', how);
      if (answer.exceptionDetails) throw new Error(answer.exceptionDetails.text);
      return answer.result.value;
    };
    tab.until = untilIn(tab);
    tab.close = () => ask('browsingContext.close', { context });
    await tab.until('typeof stats !== "undefined" && (stats.first > 0 || $("said").textContent)');
    return tab;
  };
  const close = async () => {
    const gone = new Promise((done) => firefox.once('exit', done));
    await ask('browser.close', {}).catch(() => {});
    await gone;
    spawnSync('rm', ['-rf', profile]);
  };
  return { open, close };
};

module.exports = { launch };
