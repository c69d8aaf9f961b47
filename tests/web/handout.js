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
  fs.writeFileSync(out, await tab.print());
  await browser.close();
})();
