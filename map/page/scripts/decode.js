// Columns of whole numbers: base64 of groups of seven bits, see map/page/column.h.

function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

/** The numbers of a column; exact up to 2^53. */
function numbersOf(text) {
  const bytes = bytesOf(text);
  let count = 0;
  for (let i = 0; i < bytes.length; ++i) count += bytes[i] < 128 ? 1 : 0;
  const numbers = new Float64Array(count);
  for (let i = 0, at = 0; at < count; ++at) {
    let folded = 0, place = 1;
    for (;;) {
      const byte = bytes[i++];
      folded += (byte & 127) * place;
      if (byte < 128) break;
      place *= 128;
    }
    numbers[at] = folded % 2 === 0 ? folded / 2 : -(folded + 1) / 2;
  }
  return numbers;
}

/** The running sums of a column of steps. */
function sumsOf(text) {
  const sums = numbersOf(text);
  for (let i = 1; i < sums.length; ++i) sums[i] += sums[i - 1];
  return sums;
}

/** Where each list of so many entries begins, and where the last one ends. */
function startsOf(counts) {
  const starts = new Uint32Array(counts.length + 1);
  for (let i = 0; i < counts.length; ++i) starts[i + 1] = starts[i] + counts[i];
  return starts;
}

/** Lines one after the other: points x, y in metres; line i is points starts[i] to starts[i + 1]. */
function linesOf(coded, unit) {
  const xy = numbersOf(coded.steps);
  let x = 0, y = 0;
  for (let i = 0; i < xy.length; i += 2) {
    x += xy[i];
    y += xy[i + 1];
    xy[i] = x * unit;
    xy[i + 1] = y * unit;
  }
  return {starts: startsOf(numbersOf(coded.counts)), xy};
}

/** Lists of numbers, one after the other. */
function listsOf(coded) {
  return {starts: startsOf(numbersOf(coded.counts)), values: numbersOf(coded.values)};
}

/** The entries of list i. */
function listAt(lists, i) {
  return Array.from(lists.values.subarray(lists.starts[i], lists.starts[i + 1]));
}

/** The points [x, y] of line i. */
function pointsAt(lines, i) {
  const points = [];
  for (let k = lines.starts[i]; k < lines.starts[i + 1]; ++k) points.push([lines.xy[2 * k], lines.xy[2 * k + 1]]);
  return points;
}
