// The page's data: figures as plain objects, and arrays of float32 in base64 that are decoded when first asked for.

const report = JSON.parse(document.getElementById("report-data").textContent);
const decoded = new Map();

/// The array of that name as a Float32Array; NaN where a value is not known. null for null.
function values(name) {
  if (name === null || name === undefined) return null;
  if (!decoded.has(name)) {
    const bytes = Uint8Array.from(atob(report.arrays[name]), (character) => character.charCodeAt(0));
    decoded.set(name, new Float32Array(bytes.buffer));
  }
  return decoded.get(name);
}

/// What a name means, in words; empty where nobody says.
function about(name) {
  return report.about[name] ?? "";
}

/// Row r of an array of rows of that length. An array of one row is that row for every r.
function row(array, r, length) {
  return array.length === length ? array : array.subarray(r * length, (r + 1) * length);
}

/// Where pose m lies: the text of each coordinate with its name and unit.
function positionOf(m, coordinates) {
  return coordinates.map(({ name, unit, value }) => `${name} ${withUnit(plain(values(value)[m]), unit)}`);
}

/// The entries that are numbers, and where they stand.
function known(array) {
  return d3.range(array.length).filter((i) => Number.isFinite(array[i]));
}

/// Indices by value, the largest first and the unknown last.
function ranked(array) {
  const size = (i) => (Number.isFinite(array[i]) ? array[i] : -Infinity);
  return d3.range(array.length).sort((a, b) => d3.descending(size(a), size(b)) || a - b);
}

/// Smallest and largest of the known numbers, drawn apart where they are equal; [0, 1] where none is known.
function extent(...arrays) {
  const [low, high] = d3.extent(arrays.flatMap((array) => Array.from(array).filter(Number.isFinite)));
  if (low === undefined) return [0, 1];
  if (low < high) return [low, high];
  const margin = Math.abs(low) * 0.1 || 0.5;
  return [low - margin, high + margin];
}

/// Likewise for what colours, heights or lengths stand for: where all numbers are 0, it starts there.
function valueExtent(array) {
  const range = extent(array);
  return range[0] < 0 && !Array.from(array).some((v) => v < 0) ? [0, 1] : range;
}
