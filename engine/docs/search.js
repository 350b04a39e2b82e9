// Search without a server. search_index.js holds [place, page, heading, text] of every heading; it is fetched at the first use.
// "?q=WORDS" in the address searches at once.
(() => {
  const root = document.currentScript.dataset.root;
  const most = 20;
  const plain = (text) => text.toLowerCase().normalize("NFKD").replace(/[\u0300-\u036f]/g, "");
  let loading = null;

  const load = () => {
    loading ??= new Promise((done) => {
      const script = document.createElement("script");
      script.src = `${root}/search_index.js`;
      script.onload = () => done(window.searchIndex.map((entry) => ({ entry, all: entry.map(plain) })));
      document.head.append(script);
    });
    return loading;
  };

  // Every word must be somewhere; a word in a heading counts more than one in a title or a text, a whole word more than a part.
  const score = (all, words) => {
    let sum = 0;
    for (const word of words) {
      const whole = new RegExp(`(^|[^a-z0-9_])${word.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")}($|[^a-z0-9_])`);
      const found = (part, weight) => (all[part].includes(word) ? weight * (whole.test(all[part]) ? 2 : 1) : 0);
      const points = found(2, 10) + found(1, 4) + found(3, 2);
      if (points === 0) return 0;
      sum += points;
    }
    const weight = all[1] === "c++ library" ? 0.4 : 1; // pages for users come first
    return (weight * sum) / Math.log2(16 + all[3].length / 200);
  };

  const excerpt = (text, words) => {
    const line = document.createElement("small");
    const at = Math.max(0, Math.min(...words.map((word) => plain(text).indexOf(word)).filter((k) => k >= 0), text.length) - 40);
    const part = (at > 0 ? "… " : "") + text.slice(at === text.length - 40 ? 0 : at, at + 160);
    const pattern = new RegExp(`(${words.map((word) => word.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("|")})`, "i");
    for (const piece of part.split(pattern)) {
      const marked = words.includes(plain(piece));
      const node = marked ? document.createElement("mark") : document.createTextNode(piece);
      if (marked) node.textContent = piece;
      line.append(node);
    }
    return line;
  };

  const item = ({ entry: [place, page, heading, text] }, words) => {
    const link = document.createElement("a");
    link.href = `${root}/${place}`;
    link.append(page === heading ? heading : `${page}: ${heading}`, excerpt(text, words));
    const line = document.createElement("li");
    line.append(link);
    return line;
  };

  const search = async (input, list, count) => {
    const words = plain(input.value).split(/\s+/).filter(Boolean);
    const index = words.length > 0 ? await load() : [];
    const found = index.map((one) => ({ one, points: score(one.all, words) })).filter(({ points }) => points > 0);
    found.sort((a, b) => b.points - a.points);
    list.replaceChildren(...found.slice(0, most).map(({ one }) => item(one, words)));
    if (words.length > 0 && found.length === 0) {
      const nothing = document.createElement("li");
      nothing.textContent = "Nothing has all of these words.";
      list.append(nothing);
    }
    list.hidden = words.length === 0;
    count.textContent = words.length > 0 ? `${found.length} found` : "";
  };

  document.addEventListener("DOMContentLoaded", () => {
    const [input, list, count, menu] = ["search", "found", "count", "menu"].map((id) => document.getElementById(id));
    if (window.matchMedia("(max-width: 800px)").matches) menu.open = false;
    input.addEventListener("input", () => search(input, list, count));
    input.addEventListener("keydown", (event) => {
      const first = list.querySelector("a");
      if (event.key === "Escape") list.hidden = true;
      if (event.key === "Enter" && first) first.click();
      if (event.key === "ArrowDown" && first) {
        event.preventDefault();
        first.focus();
      }
    });
    list.addEventListener("keydown", (event) => {
      const lines = [...list.querySelectorAll("a")];
      const at = lines.indexOf(document.activeElement) + { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (event.key === "Escape") {
        list.hidden = true;
        input.focus();
      } else if (!Number.isNaN(at)) {
        event.preventDefault();
        (lines[at] ?? input).focus();
      }
    });
    document.addEventListener("click", (event) => {
      if (!event.target.closest(".search")) list.hidden = true;
    });
    const asked = new URLSearchParams(window.location.search).get("q");
    if (asked) {
      input.value = asked;
      search(input, list, count);
    }
  });
})();
