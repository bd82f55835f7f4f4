// Data of the page: base64 of gzip, made into text, records and arrays.

const element = (id) => document.getElementById(id);

async function inflated(text) {
  const coded = atob(text.trim());
  const bytes = Uint8Array.from(coded, (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

// A library that is packed in the page, run as a script of the page.
async function started(id) {
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(await inflated(element(id).textContent));
  document.head.append(script);
}

// Record and arrays as umform.report.packing packs them.
async function unpacked(text) {
  const buffer = await inflated(text);
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const arrays = {};
  for (const [name, entry] of Object.entries(head.arrays)) {
    const start = 4 + length + entry.start;
    const block = buffer.slice(start, start + entry.bytes);
    arrays[name] = entry.type === "Float32Array" ? new Float32Array(block)
      : entry.type === "Uint32Array" ? new Uint32Array(block)
      : new Quantised(new Uint8Array(block), entry);
  }
  return { head, arrays };
}

class Quantised {
  constructor(planes, { low, step, frames }) {
    const count = planes.length / 2;
    Object.assign(this, { low, step, frames, size: count / frames, codes: new Uint16Array(count) });
    for (let i = 0; i < count; i += 1) {
      const before = i < this.size ? 0 : this.codes[i - this.size];
      this.codes[i] = before + planes[i] + 256 * planes[i + count];
    }
  }

  // The numbers of a frame.
  at(frame) {
    const values = new Float32Array(this.size);
    const start = frame * this.size;
    for (let i = 0; i < this.size; i += 1) values[i] = this.low + this.step * this.codes[start + i];
    return values;
  }
}

// The table of the history, from the CSV file that the page offers.
function history() {
  const href = element("history-csv").getAttribute("href");
  const lines = atob(href.slice(href.indexOf(",") + 1)).trim().split("\n").slice(1);
  const names = [...document.querySelectorAll("#history-all th")].map((cell) => cell.textContent);
  const columns = Object.fromEntries(names.map((name) => [name, []]));
  for (const line of lines) line.split(",").forEach((cell, i) => columns[names[i]].push(Number(cell)));
  return { names, columns, length: lines.length };
}

// A number with six digits, as %.6g writes it.
function digits(value) {
  if (!Number.isFinite(value)) return "nan";
  if (value === 0) return "0";
  const [mantissa, exponent] = value.toExponential(5).split("e");
  const power = Number(exponent);
  if (power < -4 || power >= 6) {
    const size = String(Math.abs(power)).padStart(2, "0");
    return `${Number(mantissa)}e${power < 0 ? "-" : "+"}${size}`;
  }
  return String(Number(value.toFixed(5 - power)));
}

// Round numbers that divide a range into about so many parts.
function ticks(low, high, parts) {
  const rough = (high - low) / parts;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 2.5, 5, 10].find((factor) => factor * power >= rough) ?? 10);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}
