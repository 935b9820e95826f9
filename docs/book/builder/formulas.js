// Typesets formulas by KaTeX. The standard input is a JSON list of LaTeX texts. The standard output
// is a list of {html}, or {error, at} with the position in the text. The argument is KaTeX's folder.
'use strict';
const katex = require(require('path').resolve(process.argv[2]));

const told = [];
console.warn = (...words) => told.push(words.join(' '));

function typeset(tex) {
  told.length = 0;
  try {
    const html = katex.renderToString(tex, { displayMode: true, strict: 'error', throwOnError: true });
    return told.length ? { error: told.join('; '), at: 0 } : { html };
  } catch (e) {
    if (!(e instanceof katex.ParseError)) throw e;
    return { error: e.rawMessage || e.message, at: e.position || 0 };
  }
}

let text = '';
process.stdin.setEncoding('utf8').on('data', part => { text += part; });
process.stdin.on('end', () => process.stdout.write(JSON.stringify(JSON.parse(text).map(typeset))));
