// Where the time goes: the share of each cause, the table, and the time along the file. Then the
// histograms of errors. The last lines begin everything.

const timeKey = report.plan ? "/plan/time_use" : "/time_use";

function setUpCauses() {
  const use = value(timeKey),
    body = document.querySelector("#causes tbody");
  use.causes.forEach((one, k) => {
    const number = numberOf(one.cause, one.axis),
      at = `${timeKey}/causes/${k}`;
    const part = make("div");
    part.style.flexGrow = one.percent;
    part.title = `${causeName(one.cause, one.axis)}: ${shown(one.percent, 3)} %`;
    part.dataset.number = number;
    element("share").append(part);

    const swatch = make("span", null, "swatch");
    swatch.dataset.number = number;
    const seconds = make("td", null, "number", figure(`${at}/seconds`, 1, 4), " s");
    const percent = make("td", null, "number", figure(`${at}/percent`, 1, 3), " %");
    const lines = make("td");
    one.lines.forEach((of, n) => {
      const name = of.from === of.to ? `${word} ${of.from}` : `${word}s ${of.from} to ${of.to}`;
      const text = make(
        "span",
        `${name} `,
        "at",
        make("small", null, "", figure(`${at}/lines/${n}/seconds`), " s"),
      );
      lines.append(text);
    });
    const first = one.lines.length && source.get(one.lines[0].from);
    if (first) lines.append(make("code", first, "first"));
    const row = make(
      "tr",
      null,
      "",
      make("td", null, "", swatch, causeName(one.cause, one.axis)),
      seconds,
      percent,
      lines,
    );
    row.dataset.cause = number;
    row.addEventListener("click", () => choose(number));
    body.append(row);
  });
  const paint = () =>
    document.querySelectorAll("[data-number]").forEach((one) => {
      one.style.background = causeColour(Number(one.dataset.number));
    });
  drawn.push(paint);
  element("lines-head").textContent = `${word}s with most of it`;
}

// Time by line of the file, one bar for each group of lines.
function setUpLines() {
  const { together, seconds } = drawing.lines,
    canvas = element("lines");
  const sums = new Map();
  seconds.forEach(([group, , s]) => sums.set(group, (sums.get(group) || 0) + s));
  const groups = [...sums.keys()],
    last = Math.max(...groups, 1),
    first = Math.min(...groups, last);
  if (sums.size < 2) {
    element("lines-figure").hidden = true;
    return;
  }
  const bars = last - first + 1;
  canvasOf(canvas, (context, width, height) => {
    const [left, foot] = [46, 18],
      wide = (width - left - 4) / bars;
    // Where bars are finer than the screen, one column shows the mean of several.
    const columns = Math.min(bars, Math.floor(width - left - 4)),
      per = bars / columns;
    const stack = Array.from({ length: columns }, () => new Map());
    seconds.forEach(([group, cause, s]) => {
      const column = stack[Math.min(columns - 1, Math.floor((group - first) / per))];
      column.set(cause, (column.get(cause) || 0) + s / per);
    });
    const totals = stack.map((column) => [...column.values()].reduce((a, b) => a + b, 0));
    const top = extent(totals)[1] || 1;
    context.fillStyle = colour("soft");
    context.textAlign = "right";
    context.strokeStyle = colour("line");
    for (const v of ticks(0, top, 2)) {
      const y = (height - foot) * (1 - (v / top) * 0.94);
      context.fillText(`${shown(v, 3)} s`, left - 6, y + (v ? 8 : 2));
      context.beginPath();
      context.moveTo(left, y);
      context.lineTo(width - 4, y);
      context.stroke();
    }
    const step = Math.max(wide * per, 1);
    stack.forEach((column, k) => {
      let y = height - foot;
      [...column]
        .sort((a, b) => a[0] - b[0])
        .forEach(([cause, s]) => {
          const high = (s / top) * 0.94 * (height - foot);
          context.fillStyle = chosen !== null && cause !== chosen ? BACKGROUND : causeColour(cause);
          context.fillRect(
            left + k * step,
            y - high,
            Math.max(step - (step > 4 ? 1 : 0), 0.8),
            high,
          );
          y -= high;
        });
    });
    context.fillStyle = colour("soft");
    context.textAlign = "center";
    for (const v of ticks(first * together, (last + 1) * together, width / 110)) {
      const x = left + (v / together - first + (together === 1 ? 0.5 : 0)) * wide;
      if (Number.isInteger(v) && x < width - 20)
        context.fillText(`${word} ${v}`, Math.max(x, left + 16), height - 4);
    }
  });
  element("lines-caption").textContent =
    together === 1 ? `Time of each ${word}.` : `Time of each group of ${together} ${word}s.`;
}

function histogram(title, caption, counts, label, format) {
  const canvas = make("canvas", null, "histogram");
  element("errors").append(
    make("figure", null, "", make("figcaption", title), canvas, make("figcaption", caption)),
  );
  canvas.setAttribute("aria-label", title);
  const top = Math.max(...counts, 1e-12);
  canvasOf(canvas, (context, width, height) => {
    const [left, foot] = [58, 20],
      wide = (width - left - 4) / counts.length;
    context.fillStyle = colour("soft");
    context.strokeStyle = colour("line");
    context.textAlign = "right";
    for (const v of ticks(0, top, 3)) {
      const y = 6 + (height - foot - 6) * (1 - v / top);
      context.fillText(format(v), left - 6, y + 4);
      context.beginPath();
      context.moveTo(left, y);
      context.lineTo(width - 4, y);
      context.stroke();
    }
    context.fillStyle = colour("fill");
    counts.forEach((count, k) => {
      const high = (count / top) * (height - foot - 6);
      context.fillRect(left + k * wide + 0.5, height - foot - high, Math.max(wide - 1, 0.5), high);
    });
    context.fillStyle = colour("soft");
    context.textAlign = "center";
    const every = Math.ceil(counts.length / (width / 70));
    for (let k = 0; k <= counts.length; k += every)
      context.fillText(label(k), Math.min(left + k * wide, width - 14), height - 5);
  });
}

function setUpErrors() {
  const percent = (of) => (k) => `${shown((100 * k) / of)} %`;
  if (report.check && report.check.deviation_counts) {
    const counts = report.check.deviation_counts;
    histogram(
      "Pulses by the distance of the tool from the programmed path",
      "part of what is allowed: the tolerance and one step of each axis",
      counts,
      percent(counts.length - 1),
      brief,
    );
  }
  const planned = value(timeKey).distance_seconds;
  if (planned.some((s) => s > 0)) {
    histogram(
      "Time by the distance of the planned curve from the programmed path",
      "part of the tolerance; seconds",
      planned,
      percent(planned.length),
      (v) => `${shown(v, 3)} s`,
    );
  }
  (report.error_counts || [])
    .filter((axis) => axis.counts.length)
    .forEach((axis) => {
      histogram(
        `Pulses of ${axis.axis} by their error: edge less profile`,
        "ns",
        axis.counts,
        (k) => shown(axis.from_ns + k * axis.width_ns, 3),
        brief,
      );
    });
  if (!element("errors").children.length) element("errors-section").hidden = true;
}

fillHead();
setUpCauses();
setUpLines();
setUpCharts();
setUpPath();
setUpErrors();
fillNotes();
redraw();
isDark.addEventListener("change", redraw);
window.addEventListener("resize", redraw);
document.documentElement.dataset.ready = "yes";
