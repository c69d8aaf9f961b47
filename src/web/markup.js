// markup.js - makes elements of texts in the markup of text.h: words stay text,
// formulas become MathML.
//
//   parse    markup -> parts: {text}, {colour, of}, {up}, {down}, {above, below},
//            {rows}, {under} a root; `of`, `up`, ... are lists of parts
//   row      parts -> MathML; blanks of the text are the spaces around signs
//   prose    parts -> text, spans, and a <math> for each word with a formula
//   formula  parts -> a <math> for each side of =, so that lines can break there
'use strict'; // of the page's whole script, which begins here

const make = (name, children = [], attributes = {}, space = 'http://www.w3.org/1999/xhtml') => {
  const element = document.createElementNS(space, name);
  element.append(...children);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
};
const math = (name, children, attributes) =>
  make(name, children, attributes, 'http://www.w3.org/1998/Math/MathML');

// ---- parse ------------------------------------------------------------------

const LETTERS = { x: 'x', xt: 'x\u0303', p: 'p', alpha: 'α' };
const SLIDES = /(?<![\^_]|frac|matrix|#[\w-]*)\{(x|xt|p|alpha)\}/g;
const OPENS = /(\^|_|frac|matrix|#[a-z0-9-]*)\{|√\(/;

// Returns the index of a word outside of all braces, or the length of the text.
const find = (text, word, from = 0) => {
  let [at, depth] = [from, 0];
  for (; at < text.length && (depth > 0 || !text.startsWith(word, at)); at++)
    depth += (text[at] === '{') - (text[at] === '}');
  return at;
};
// Splits a text at a word outside of all braces.
const split = (text, word) => {
  const at = find(text, word);
  const rest = text.slice(at + word.length);
  return at < text.length ? [text.slice(0, at), ...split(rest, word)] : [text];
};

const parse = (text) => {
  const found = OPENS.exec(text);
  if (!found) return text ? [{ text }] : [];
  const parts = found.index ? [{ text: text.slice(0, found.index) }] : [];
  const from = found.index + found[0].length;
  const word = found[1];
  const end = find(text, word ? '}' : ')', from);
  const inside = text.slice(from, end);
  if (!word) parts.push({ under: parse(inside) });
  else if (word === '^') parts.push({ up: parse(inside) });
  else if (word === '_') parts.push({ down: parse(inside) });
  else if (word === 'frac') {
    const [above, below = ''] = split(inside, ' over ');
    parts.push({ above: parse(above), below: parse(below) });
  } else if (word === 'matrix') {
    const cells = (line) => split(line, '&').map((cell) => parse(cell.trim()));
    parts.push({ rows: split(inside, ';').map(cells) });
  } else parts.push({ colour: word.slice(1), of: parse(inside) });
  return [...parts, ...parse(text.slice(end + 1))];
};

// ---- formulas ---------------------------------------------------------------

const TOKEN = /[ \u00a0]+|\d+(?:[.,]\d+)*|(?:[A-Za-zα-ωΑ-Ω][\u0300-\u036f]*|_)+|./gsu;
const LETTER = /[A-Za-zα-ωΑ-Ω][\u0300-\u036f]*/gu;
const RAISED = { '²': '2', '³': '3', ᵀ: 'T', ⁿ: 'n', '⁻': '−', '⁺': '+', '¹': '1' };
const SHORT = /^(kg|mm|ms|ln|if|of|so|at|in|to|by|up|on|or|no|as|is|it)$/; // words
const UNIT = /^(m|N|s|J|kg|mm|ms)$/;
const PLAIN = /[∇∂∞½¼°…⋯⋮⋱%]/; // signs without space around
const OPEN = /[([{|‖]/;
const CLOSE = /[)\]}|‖,;:]/;
const SIGN = { stretchy: false, largeop: false, movablelimits: false, rspace: 0 };

// Combining marks, which MathML sets as accents above their letter.
const LIDS = { '\u0302': '^', '\u0303': '~', '\u0304': '¯', '\u0307': '˙', '\u0308': '¨' };
const letterOf = (letter) => {
  const base = math('mi', [letter[0]]);
  const lid = LIDS[letter[1]] && math('mo', [LIDS[letter[1]]], { stretchy: false });
  return lid ? math('mover', [base, lid], { accent: true }) : base;
};

// Hangs a superscript or subscript on the last element; a base may have both.
const hang = (out, up, body) => {
  const base = out.pop() || math('mi');
  const both = base.localName === (up ? 'msub' : 'msup');
  const [core, other] = both ? base.children : [];
  if (!both) return out.push(math(up ? 'msup' : 'msub', [base, body]));
  return out.push(math('msubsup', up ? [core, other, body] : [core, body, other]));
};

// "²" becomes a superscript, "Ĥ" the letter H and its mark.
const spellOut = (part) => {
  const raise = (signs) => `^{${signs.replace(/./g, (sign) => RAISED[sign])}}`;
  const letters = part.text?.replace(/[\u00c0-\u017f]/g, (letter) => letter.normalize('NFD'));
  return letters ? parse(letters.replace(/[²³ᵀⁿ⁻⁺¹]+/g, raise)) : part;
};

const row = (parts) => {
  const out = [];
  let blank = 0; // number of blanks before the next element
  let sign = true; // no element or a sign stands before: a minus is a prefix
  let unit = false; // the last element is a unit, or a stroke after a unit
  let root = false; // the next element is below a root
  const put = (element) => {
    if (blank > 0) out.push(math('mspace', [], { width: blank > 1 ? '1.2em' : '0.25em' }));
    out.push(root ? math('msqrt', [element]) : element);
    blank = 0;
    sign = root = false;
  };
  const token = (text) => {
    const last = out[out.length - 1];
    const upright = () => put(math('mtext', [text])); // not mi: Firefox puts a gap behind it
    if (/^[ \u00a0]/.test(text)) blank = text.length;
    else if (/[′″]/.test(text)) out.push(math('mo', [text], { ...SIGN, lspace: 0 }));
    else if (text === '√') root = true;
    else if (/^\d/.test(text)) put(math('mn', [text]));
    else {
      // "hω" is a product, "kg" and "tanh" are words; "2 m" and "J/m" have units.
      const letters = text.match(LETTER);
      const counts = blank && !sign && /^(mn|msup|mo|mtable)$/.test(last?.localName);
      if (text !== '/')
        unit = UNIT.test(text) && (unit ? blank > 0 || last?.textContent === '/' : counts);
      if (unit && text !== '/') return upright();
      const short = letters?.length === 1 || (letters?.length === 2 && !SHORT.test(text));
      if (letters && (short || /[α-ωΑ-Ω]/u.test(text)))
        return letters.forEach((letter) => put(letterOf(letter)));
      if (letters) return put(math('mi', [text]));
      if (PLAIN.test(text)) return upright();
      const how = { ...SIGN, lspace: blank ? '0.25em' : 0 };
      const fence = OPEN.test(text) || CLOSE.test(text);
      if (!fence) how.form = sign ? 'prefix' : 'infix';
      if (blank > 1) put(math('mspace'));
      out.push(math('mo', [text], how));
      blank = 0;
      sign = !CLOSE.test(text) || /[,;:]/.test(text);
    }
  };
  for (const { text, up, down, above, below, rows, under, of, colour } of parts.flatMap(spellOut)) {
    if (text) for (const [one] of text.matchAll(TOKEN)) token(one);
    else if (up) hang(out, true, math('mrow', row(up)));
    else if (down) hang(out, false, math('mrow', row(down)));
    else if (above) put(math('mfrac', [math('mrow', row(above)), math('mrow', row(below))]));
    else if (under) put(math('msqrt', [math('mrow', row(under))]));
    else if (rows) {
      const line = (cells) => cells.map((cell) => math('mtd', row(cell)));
      const lines = rows.map((cells) => math('mtr', line(cells)));
      put(math('mtable', lines)); // page.css draws its brackets
    } else if (of) put(coloured(math('mrow', row(of)), colour));
  }
  return out;
};

// ---- words ------------------------------------------------------------------

const coloured = (element, name) => {
  element.style.color = ask('web_get_colour', 'string', name);
  return element;
};
const isLetter = ({ colour, of }) =>
  colour && of.length === 1 && /^.[\u0300-\u036f]?$/u.test(of[0].text || '');
const isSet = (part) => !(part.text || part.of) || isLetter(part) || /[|‖∇∂√]/.test(part.text);

const prose = (parts) => {
  const out = [];
  let word = [];
  const flush = (...next) => {
    if (word.some(isSet)) out.push(math('math', row(word)));
    else out.push(...word.map((part) => part.text));
    out.push(...next);
    word = [];
  };
  for (const part of parts)
    if (part.text !== undefined)
      part.text.split(' ').forEach((text, i) => {
        if (i > 0) flush(' ');
        if (text) word.push({ text });
      });
    else if (!part.colour || isLetter(part)) word.push(part);
    else flush(coloured(make('span', prose(part.of)), part.colour));
  flush();
  return out;
};

const SIDES = /( {2,}|(?<=[,:]) | (?=[=≈≤≥<>→⇔+−] ))/;
const formula = (parts) => {
  const sides = [[]];
  let depth = 0; // of parentheses
  let bars = 0;
  for (const part of parts) {
    if (part.of?.some(({ text }) => / /.test(text)))
      sides.push(coloured(make('span', formula(part.of).slice(0, -1)), part.colour), []);
    else if (part.text === undefined) sides.at(-1).push(part);
    else
      part.text.split(SIDES).forEach((text, i) => {
        if (i % 2 && depth === 0 && bars % 2 === 0)
          sides.push(text.length > 1 ? '\u2003' : ' ', []);
        else if (text) sides.at(-1).push({ text });
        depth += text.split('(').length - text.split(')').length;
        bars += text.split('|').length - 1;
      });
  }
  return sides.flatMap((side) => {
    if (!Array.isArray(side)) return [side];
    return side.length ? [math('math', row(side), { displaystyle: true }), ' '] : [];
  });
};

// Shows a text in an element, which keeps its content if the text is the same.
const setMarkup = (element, text, asFormula) => {
  if (!isNew(element, 'markup', text)) return element;
  const letters = text.replace(SLIDES, (all, name) => `#${name}{${LETTERS[name]}}`);
  element.replaceChildren(...(asFormula ? formula : prose)(parse(letters)));
  element.normalize(); // screen readers pause between text nodes
  return element;
};
