// Numbers as texts for readers.

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

function powerOfTen(exponent) {
  const digits = Array.from(String(Math.abs(exponent)), (digit) => SUPERSCRIPTS[digit]).join("");
  return `10${exponent < 0 ? "⁻" : ""}${digits}`;
}

/// The digits of a whole number in groups of three, as in the tables.
function grouped(digits) {
  return digits.replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/// A number with three significant digits, as in the tables but without trailing zeros. Powers of ten are used if a
/// reader would have to count zeros.
function number(value) {
  if (!Number.isFinite(value)) return "unknown";
  if (value === 0) return "0";
  const sign = value < 0 ? "−" : "";
  const [mantissa, exponent] = Math.abs(value).toExponential(2).split("e").map(Number);
  if (exponent < -3 || exponent > 5) return `${sign}${mantissa} × ${powerOfTen(exponent)}`;
  const text = String(Number(Math.abs(value).toFixed(Math.max(0, 2 - exponent))));
  return sign + (exponent >= 3 ? grouped(text) : text);
}

/// A number with up to five significant digits, for coordinates and counts.
function plain(value) {
  return Number.isFinite(value) ? String(Number(value.toPrecision(5))).replace("-", "−") : "unknown";
}

/// Whether a quantity has a unit. The unit of numbers without unit is "1".
function isUnit(unit) {
  return Boolean(unit) && unit !== "1";
}

function withUnit(text, unit) {
  return isUnit(unit) ? `${text}\u202f${unit}` : text;
}

/// A value with its unit, and its interval on a second line if it is known.
function withInterval({ value, low, high }, unit) {
  const text = withUnit(number(value), unit);
  return Number.isFinite(low) ? `${text}\ninterval ${number(low)} to ${withUnit(number(high), unit)}` : text;
}

/// A label with its unit, "label [unit]", as in the tables.
function labelled(label, unit) {
  return isUnit(unit) ? `${label} [${unit}]` : label;
}

/// The factor by which an axis is divided so that its ticks are short numbers, and the unit that follows from it.
function axisUnit(domain, unit) {
  const largest = Math.max(Math.abs(domain[0]), Math.abs(domain[1]));
  const exponent = largest > 0 ? Math.floor(Math.log10(largest)) : 0;
  if (exponent >= -3 && exponent < 5) return { factor: 1, unit };
  const power = 3 * Math.floor(exponent / 3);
  return { factor: 10 ** power, unit: `${powerOfTen(power)}${isUnit(unit) ? ` ${unit}` : ""}` };
}

/// Ticks of a logarithmic axis, at most `most`: powers of ten, and also their multiples by 2 and 5 if these are few.
function logTicks([low, high], most) {
  const powers = d3.range(Math.floor(Math.log10(low)), Math.ceil(Math.log10(high)) + 1);
  const all = (multiples) =>
    powers.flatMap((p) => multiples.map((m) => m * 10 ** p)).filter((v) => v >= low * 0.999 && v <= high * 1.001);
  const tens = all([1]);
  const finer = all([1, 2, 5]);
  if (tens.length < 3 && finer.length <= Math.max(4, most)) return finer;
  const step = Math.ceil(tens.length / Math.max(2, most));
  return tens.filter((_, k) => k % step === 0);
}

/// The text of a tick of a linear axis, with as many decimals as the distance between ticks needs.
function tickText(value, k, ticks) {
  const step = ticks?.length > 1 ? Math.abs(ticks[1] - ticks[0]) : Math.abs(value) || 1;
  const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9) + (isRound(step) ? 0 : 1));
  const [whole, part] = Math.abs(value).toFixed(Math.min(decimals, 12)).split(".");
  const text = (whole.length > 3 ? grouped(whole) : whole) + (part ? `.${part}` : "");
  return value < 0 && Number(text.replace(/\s/g, "")) !== 0 ? `−${text}` : text;
}

/// Whether the step between ticks has one significant digit.
function isRound(step) {
  const digits = step / 10 ** Math.floor(Math.log10(step) + 1e-9);
  return Math.abs(digits - Math.round(digits)) < 1e-6;
}

function logTick(value) {
  const exponent = Math.floor(Math.log10(value) + 1e-9);
  if (exponent >= -2 && exponent <= 5) {
    const text = String(Number(value.toPrecision(1)));
    return exponent >= 3 ? grouped(text) : text;
  }
  const multiple = Math.round(value / 10 ** exponent);
  return `${multiple > 1 ? `${multiple} × ` : ""}${powerOfTen(exponent)}`;
}
