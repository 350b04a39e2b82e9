// The data of the page: figures as plain objects, and arrays of float32 in base64, which are decoded when they are
// first used.

const report = JSON.parse(document.getElementById("report-data").textContent);
const decoded = new Map();

/// The array of this name as a Float32Array, with NaN for values that are not known. null if there is no name.
function values(name) {
  if (name === null || name === undefined) return null;
  if (!decoded.has(name)) {
    const bytes = Uint8Array.from(atob(report.arrays[name]), (character) => character.charCodeAt(0));
    decoded.set(name, new Float32Array(bytes.buffer));
  }
  return decoded.get(name);
}

/// What a name means, in words; empty if no explanation is known.
function about(name) {
  return report.about[name] ?? "";
}

/// Row r of an array whose rows have this length. An array with only one row gives this row for every r.
function row(array, r, length) {
  return array.length === length ? array : array.subarray(r * length, (r + 1) * length);
}

/// The coordinates of pose m as texts, each with its name and unit.
function positionOf(m, coordinates) {
  return coordinates.map(({ name, unit, value }) => `${name} ${withUnit(plain(values(value)[m]), unit)}`);
}

/// The indices of the entries that are finite numbers.
function known(array) {
  return d3.range(array.length).filter((i) => Number.isFinite(array[i]));
}

/// Indices ordered by value, the largest first and unknown values last.
function ranked(array) {
  const size = (i) => (Number.isFinite(array[i]) ? array[i] : -Infinity);
  return d3.range(array.length).sort((a, b) => d3.descending(size(a), size(b)) || a - b);
}

/// The smallest and the largest of the known numbers. Equal ones are moved apart; [0, 1] if no number is known.
function extent(...arrays) {
  const [low, high] = d3.extent(arrays.flatMap((array) => Array.from(array).filter(Number.isFinite)));
  if (low === undefined) return [0, 1];
  if (low < high) return [low, high];
  const margin = Math.abs(low) * 0.1 || 0.5;
  return [low - margin, high + margin];
}

/// The extent() of values that colours, heights or lengths show. If no number is negative, it does not begin below 0.
function valueExtent(array) {
  const range = extent(array);
  return range[0] < 0 && !Array.from(array).some((v) => v < 0) ? [0, 1] : range;
}
