// handout.js PAGE OUT.pdf [QUERY]: prints the lecture with Chromium, as `Print` in
// a browser does.  QUERY: "?notes" adds the presenter's notes.
'use strict';
const fs = require('fs');
const path = require('path');
const { launch } = require('./browser.js');

const [page, out, query = ''] = process.argv.slice(2);

(async () => {
  const browser = await launch();
  const tab = await browser.open(`file://${path.resolve(page)}${query}`);
  await tab.run('printLecture()');
  const { data } = await tab.ask('Page.printToPDF', { preferCSSPageSize: true });
  fs.writeFileSync(out, Buffer.from(data, 'base64'));
  await browser.close();
})();
