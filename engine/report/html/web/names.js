// Names as print has them: epsilon_1_4_y is an epsilon with its indices below. What is copied, searched and read aloud
// stays the plain name.

const GREEK = {
  alpha: "α", beta: "β", gamma: "γ", delta: "δ", epsilon: "ε", zeta: "ζ", eta: "η", theta: "θ", iota: "ι", kappa: "κ",
  lambda: "λ", mu: "μ", nu: "ν", xi: "ξ", pi: "π", rho: "ρ", sigma: "σ", tau: "τ", phi: "φ", chi: "χ", psi: "ψ",
  omega: "ω",
};
const INDEX = /^(\d+(\.\d+)?|[A-Za-z]{1,2})$/;
// A word that may be a name, not part of a path, of another word or of what is called.
const WORD = /(?<![\w./-])[A-Za-z]+(?:_(?:\d+(?:\.\d+)?|[A-Za-z]+\d*))*(?![\w(]|\.\w)/g;
const SUB_SIZE = 0.78;

/// {letter, index} of a letter with indices, or of a Greek letter's name; undefined for any other word.
function symbolOf(word) {
  const [first, ...indices] = word.split("_");
  if (word === "delta") return undefined; // a robot, in prose
  const letter = GREEK[first] ?? (first.length === 1 && indices.length ? first : undefined);
  const shown = indices.map((index) => GREEK[index] ?? index);
  const fits = indices.every((index) => index in GREEK || INDEX.test(index));
  return letter && fits ? { letter, index: shown.join(",") } : undefined;
}

/// The text in pieces: plain ones as {text}, names as {text, letter, index}.
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

/// Nodes of a text: names are shown by generated content, which is neither copied nor read aloud.
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

/// Sets the names in the texts of an SVG.
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

// What a command, a file or a choice says is typed as it stands.
const AS_IT_STANDS =
  "script, style, pre, code, select, textarea, svg, [role=status], .name, [data-table^=settings], [data-table^=what_was]";
const NUMBERS = /(\d{1,3}(?: \d{3})+(?!\d)(?: %)?|\d[\d.]* %)/;

/// Sets the names in the page's texts, and keeps numbers in one piece: those whose digits stand in groups, and percents.
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
