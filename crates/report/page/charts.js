// Speed, acceleration and jerk of each axis over time, as bands from the least to the greatest
// value, with the limits; all charts show the same part of the time.

const time = { from: 0, to: 1, whole: 1, mark: null, drag: null };

// Marks a time in all charts.
function showTime(seconds) {
  if (time.mark === seconds) return;
  time.mark = seconds;
  chartDraws.forEach((draw) => draw());
}
const chartDraws = [];

function stretchesBetween(from, to) {
  const { seconds, cause } = drawing.charts;
  const first = Math.max(0, Math.floor(from / seconds)),
    last = Math.min(cause.length - 1, Math.ceil(to / seconds));
  return [first, last];
}

function chart(canvas, curve, limit) {
  const { seconds, low, high } = drawing.charts;
  const [lows, highs] = [low[curve], high[curve]];
  const most = Math.max(extent(highs)[1], -extent(lows)[0]);
  const top = (limit !== null ? Math.max(limit, most) : most || 1) * 1.12;
  const bottom = extent(lows)[0] < 0 ? -top : 0;
  const draw = canvasOf(canvas, (context, width, height) => {
    const [left, right, foot, head] = [46, 4, 18, 6];
    const x = (t) => left + ((t - time.from) / (time.to - time.from)) * (width - left - right);
    const y = (v) => head + ((top - v) / (top - bottom)) * (height - foot - head);
    context.lineWidth = 1;
    context.strokeStyle = colour("line");
    context.fillStyle = colour("soft");
    context.textAlign = "right";
    for (const v of ticks(bottom, top, 3)) {
      context.beginPath();
      context.moveTo(left, y(v));
      context.lineTo(width - right, y(v));
      context.stroke();
      context.fillText(brief(v), left - 6, y(v) + 4);
    }
    context.textAlign = "center";
    for (const t of ticks(time.from, time.to, width / 110)) {
      if (x(t) > left + 10 && x(t) < width - 14)
        context.fillText(`${shown(t)} s`, x(t), height - 4);
    }
    context.save();
    context.beginPath();
    context.rect(left, 0, width - left - right, height - foot + 2);
    context.clip();
    const [first, last] = stretchesBetween(time.from, time.to);
    context.beginPath();
    for (let k = first; k <= last; k++) {
      context.lineTo(x(k * seconds), y(highs[k]));
      context.lineTo(x((k + 1) * seconds), y(highs[k]));
    }
    for (let k = last; k >= first; k--) {
      context.lineTo(x((k + 1) * seconds), y(lows[k]));
      context.lineTo(x(k * seconds), y(lows[k]));
    }
    context.closePath();
    context.fillStyle = context.strokeStyle = colour("fill");
    context.globalAlpha = 0.35;
    context.fill();
    context.globalAlpha = 1;
    context.lineJoin = "round";
    context.stroke();
    if (limit !== null) {
      context.strokeStyle = colour("limit");
      context.setLineDash([5, 4]);
      (bottom < 0 ? [limit, -limit] : [limit]).forEach((v) => {
        context.beginPath();
        context.moveTo(left, y(v));
        context.lineTo(width - right, y(v));
        context.stroke();
      });
      context.setLineDash([]);
    }
    if (time.mark !== null) {
      context.strokeStyle = colour("ink");
      context.beginPath();
      context.moveTo(x(time.mark), 0);
      context.lineTo(x(time.mark), height);
      context.stroke();
    }
    if (time.drag) {
      context.fillStyle = colour("mark");
      context.globalAlpha = 0.18;
      context.fillRect(x(time.drag[0]), 0, x(time.drag[1]) - x(time.drag[0]), height);
    }
    context.restore();
  });
  chartDraws.push(draw);

  const at = (event) =>
    time.from + ((event.offsetX - 46) / (canvas.clientWidth - 50)) * (time.to - time.from);
  const all = () => chartDraws.forEach((draw) => draw());
  canvas.addEventListener("pointerdown", (event) => {
    time.drag = [at(event), at(event)];
    if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!time.drag) return;
    time.drag[1] = at(event);
    all();
  });
  canvas.addEventListener("pointerup", () => {
    const [from, to] = (time.drag || [0, 0]).slice().sort((a, b) => a - b);
    time.drag = null;
    if (to - from > 3 * drawing.charts.seconds) seeTime(from, to);
    else all();
  });
  canvas.addEventListener("pointercancel", () => {
    time.drag = null;
    all();
  });
}

// A number for the edge of a chart: 250k.
function brief(v) {
  const big = Math.abs(v);
  const text =
    big >= 1e6 ? `${shown(v / 1e6, 3)}M` : big >= 1e4 ? `${shown(v / 1e3, 3)}k` : shown(v, 4);
  return text;
}

function seeTime(from, to) {
  [time.from, time.to] = [Math.max(0, from), Math.min(time.whole, to)];
  chartDraws.forEach((draw) => draw());
}

// A coloured line of what binds over time.
function strip(canvas) {
  const { seconds, cause } = drawing.charts;
  chartDraws.push(
    canvasOf(canvas, (context, width, height) => {
      const [left, right] = [46, 4],
        wide = width - left - right;
      const [first, last] = stretchesBetween(time.from, time.to);
      const x = (t) =>
        left + Math.min(Math.max((t - time.from) / (time.to - time.from), 0), 1) * wide;
      for (let k = first; k <= last; k++) {
        context.fillStyle =
          chosen !== null && cause[k] !== chosen ? BACKGROUND : causeColour(cause[k]);
        const from = Math.floor(x(k * seconds));
        context.fillRect(from, 0, Math.max(Math.ceil(x((k + 1) * seconds)) - from, 1), height);
      }
    }),
  );
}

function setUpCharts() {
  time.whole = value(under("total_s"));
  time.to = time.whole || 1;
  const box = element("charts");
  const add = (parent, curve, limit, ...text) => {
    const canvas = make("canvas", null, "chart");
    const part = make("div", null, "", make("p", null, "", ...text), canvas);
    parent.append(part);
    chart(canvas, curve, limit);
    return part;
  };
  const solo = make("div", null, "solo");
  box.append(solo);
  const stripe = make("canvas", null, "strip");
  add(solo, 0, null, `speed along the path, ${unit}/s, and what binds`).append(stripe);
  strip(stripe);
  drawing.axes.forEach((axis, k) => {
    const trio = make("div", null, "trio");
    box.append(make("h3", axis.title), trio);
    const kinds = [
      ["speed", "speed", "/s"],
      ["acceleration", "acceleration", "/s\u00b2"],
      ["jerk", "jerk", "/s\u00b3"],
    ];
    kinds.forEach(([label, key, per], kind) => {
      const limit = axis.limits[kind],
        curve = 1 + 3 * k + kind;
      // Without a limit, a jerk that is always 0 is not worth a chart.
      const flat =
        drawing.charts.low[curve].every((v) => v === 0) &&
        drawing.charts.high[curve].every((v) => v === 0);
      if (limit === null && flat) return;
      const seconds = kind ? kind + 1 : "";
      const pointer = `${under("axes")}/${k}/${key}_steps_per_s${seconds}`;
      const steps = axis.steps_per_unit;
      const text = [`${label}, ${axis.unit}${per}`];
      const bold = make("b");
      if (value(pointer) !== undefined) {
        bold.append(figure(pointer, steps));
        const of = pointer.replace("_steps", "_limit_steps");
        text.push(": ", bold);
        if (limit !== null && value(of) !== undefined) text.push(" of ", figure(of, steps));
      } else if (limit === null) {
        text.push(": no limit");
      }
      add(trio, curve, limit, ...text);
    });
  });
  element("time-all").addEventListener("click", () => seeTime(0, time.whole));
}
