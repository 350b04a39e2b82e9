// Shows names as in print: epsilon_1_4_y becomes an epsilon with its indices below. Copied text, searches and screen
// readers get the plain name.

const GREEK = {
  alpha: "α", beta: "β", gamma: "γ", delta: "δ", epsilon: "ε", zeta: "ζ", eta: "η", theta: "θ", iota: "ι", kappa: "κ",
  lambda: "λ", mu: "μ", nu: "ν", xi: "ξ", pi: "π", rho: "ρ", sigma: "σ", tau: "τ", phi: "φ", chi: "χ", psi: "ψ",
  omega: "ω",
};
const INDEX = /^(\d+(\.\d+)?|[A-Za-z]{1,2})$/;
// A word that may be a name. It is not part of a path or of another word, and is not followed by a bracket.
const WORD = /(?<![\w./-])[A-Za-z]+(?:_(?:\d+(?:\.\d+)?|[A-Za-z]+\d*))*(?![\w(]|\.\w)/g;
const SUB_SIZE = 0.78;

/// {letter, index} of a name that is a letter with indices or a Greek letter; undefined for any other word.
function symbolOf(word) {
  const [first, ...indices] = word.split("_");
  if (word === "delta") return undefined; // in prose this word means a kind of robot
  const letter = GREEK[first] ?? (first.length === 1 && indices.length ? first : undefined);
  const shown = indices.map((index) => GREEK[index] ?? index);
  const fits = indices.every((index) => index in GREEK || INDEX.test(index));
  return letter && fits ? { letter, index: shown.join(",") } : undefined;
}

/// The pieces of a text: plain ones as {text}, names as {text, letter, index}.
function pieces(text) {
  const list = [];
  let end = 0;
  for (const { 0: word, index: at } of text.matchAll(WORD)) {
    const symbol = symbolOf(word);
    if (!symbol) continue;
    if (at > end) list.push({ text: text.slice(end, at) });
    list.push({ text: word, ...symbol });
    end = at + word.length;
  }
  if (end < text.length) list.push({ text: text.slice(end) });
  return list;
}

/// The nodes for a text. Names are shown by generated content, which is neither copied nor read aloud.
function named(text) {
  return pieces(text).map(({ text: plain, letter, index }) => {
    if (!letter) return plain;
    const meaning = about(plain);
    return element(
      "span",
      { class: "name", "data-letter": letter, "data-index": index, title: meaning ? `${plain}: ${meaning}` : plain },
      element("span", {}, plain),
    );
  });
}

/// Shows names as in print in the texts of an SVG.
function setNames(svg) {
  for (const text of svg.querySelectorAll("text")) {
    if (text.children.length || !text.textContent) continue;
    const parts = pieces(text.textContent);
    if (!parts.some(({ letter }) => letter)) continue;
    let lowered = 0;
    const piece = (content, attributes, low) => {
      const made = svgElement("tspan", { ...attributes, dy: `${low - lowered}px` }, content);
      lowered = low;
      return made;
    };
    text.replaceChildren(
      ...parts.flatMap(({ text: plain, letter, index }) =>
        letter
          ? [piece(letter, { "font-style": "italic" }, 0), ...(index ? [piece(index, { "font-size": `${SUB_SIZE}em` }, 3)] : [])]
          : [piece(plain, {}, 0)],
      ),
    );
  }
}

// Elements whose text stays as it is typed, because a reader may copy it: commands, files, choices.
const AS_IT_STANDS =
  "script, style, pre, code, select, textarea, svg, [role=status], .name, [data-table^=settings], [data-table^=what_was]";
const NUMBERS = /(\d{1,3}(?: \d{3})+(?!\d)(?: %)?|\d[\d.]* %)/;

/// Shows names as in print in the texts of an element, and keeps numbers on one line that have groups of digits or are
/// percentages.
function setTexts(root) {
  const texts = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  const found = [];
  while (texts.nextNode()) {
    const { data, parentElement } = texts.currentNode;
    if (data.trim() && !data.includes("--") && !parentElement.closest(AS_IT_STANDS)) found.push(texts.currentNode);
  }
  const whole = (part, k) => (k % 2 ? [element("span", { class: "whole" }, part)] : named(part));
  for (const text of found) {
    const nodes = text.data.split(NUMBERS).flatMap(whole);
    if (nodes.some((node) => typeof node !== "string")) text.replaceWith(...nodes);
  }
}
