// A strict reader of the XML that JUnit files need: elements, attributes, text, the five entities and character
// references. It throws at whatever is not well-formed.

const ENTITIES = { amp: '&', lt: '<', gt: '>', quot: '"', apos: "'" };

function decoded(text) {
  if (/[<\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]/.test(text)) throw new Error(`no XML text: ${text}`);
  return text.replaceAll(/&([^;&]*);?/g, (whole, name) => {
    if (!whole.endsWith(';')) throw new Error(`a bare & in ${text}`);
    if (/^#\d+$/.test(name)) return String.fromCodePoint(Number(name.slice(1)));
    if (!(name in ENTITIES)) throw new Error(`no entity: ${whole}`);
    return ENTITIES[name];
  });
}

function attributesOf(text) {
  const attributes = {};
  const rest = text.replaceAll(/\s+([A-Za-z][\w.-]*)="([^"]*)"/g, (whole, name, value) => {
    if (name in attributes) throw new Error(`${name} stands twice in ${text}`);
    attributes[name] = decoded(value);
    return '';
  });
  if (rest.trim()) throw new Error(`no attributes: ${text}`);
  return attributes;
}

/** The root element: { name, attributes, children, text }. */
export function parseXml(text) {
  const declaration = /^<\?xml version="1\.0" encoding="UTF-8"\?>\s*/.exec(text);
  if (!declaration) throw new Error('no XML declaration');
  const root = { name: '', attributes: {}, children: [], text: '' };
  const open = [root];
  for (const [whole, tag, plain] of text.slice(declaration[0].length).matchAll(/<([^<>]*)>|([^<>]+)|[<>]/g)) {
    const parent = open.at(-1);
    if (plain !== undefined) parent.text += decoded(plain);
    else if (tag === undefined) throw new Error(`a bare ${whole}`);
    else if (tag.startsWith('/')) {
      if (open.pop().name !== tag.slice(1)) throw new Error(`</${tag.slice(1)}> closes another element`);
    } else {
      const [, name, words, slash] = /^([A-Za-z][\w.-]*)([^/]*(?:"[^"]*"[^/"]*)*?)(\/?)$/.exec(tag) ?? [];
      if (!name) throw new Error(`no element: ${tag}`);
      const element = { name, attributes: attributesOf(words), children: [], text: '' };
      parent.children.push(element);
      if (!slash) open.push(element);
    }
  }
  if (open.length !== 1 || root.children.length !== 1 || root.text.trim()) throw new Error('not one root element');
  return root.children[0];
}
