// The path: coloured by speed or by what binds, seen from above or from a side, with pan, zoom and
// a range of heights.

const pathView = {
  scale: 1,
  x: 0,
  y: 0,
  side: "top",
  by: "speed",
  low: -Infinity,
  high: Infinity,
  fit: true,
  at: null,
};

// Where a point is in the picture before pan and zoom; up is positive.
const SIDES = {
  top: (x, y) => [x, y],
  front: (x, y, z) => [x, z],
  side: (x, y, z) => [y, z],
  oblique: (x, y, z) => [0.866 * (x - y), 0.5 * (x + y) + z],
  time: (x, y, z, t) => [t, x],
};
const BACKGROUND = "rgba(128, 136, 148, .22)";
const SHADES = 48;

function extent(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const one of values) {
    low = Math.min(low, one);
    high = Math.max(high, one);
  }
  return [low, high];
}

function setUpPath() {
  const { path } = drawing,
    canvas = element("path"),
    view = pathView;
  const count = path.line.length;
  const size = [path.x, path.y, path.z].map((values) => {
    const [a, b] = extent(values);
    return b - a;
  });
  const fastest = extent(path.speed)[1] || 1;
  const names = path.over.map((axis) => drawing.axes[axis].name);
  const last = path.t[count - 1] || 1;
  // One axis alone is drawn over time.
  if (path.over.length === 1) view.side = "time";
  else if (size[2] > 0 && Math.max(size[0], size[1]) < 0.02 * size[2])
    view.side = size[0] >= size[1] ? "front" : "side";

  let flat = [];
  function project() {
    const to = SIDES[view.side];
    // Time is stretched to the size of the way.
    const stretch = view.side === "time" ? ((size[0] || 1) * 1.8) / last : 1;
    flat = path.x.map((x, k) => to(x, path.y[k], path.z[k], k ? path.t[k - 1] * stretch : 0));
  }
  project();

  function fit(width, height) {
    const [x0, x1] = extent(flat.map((p) => p[0])),
      [y0, y1] = extent(flat.map((p) => p[1]));
    const room = 28;
    view.scale = Math.min(
      (width - 2 * room) / Math.max(x1 - x0, 1e-9),
      (height - 2 * room) / Math.max(y1 - y0, 1e-9),
    );
    if (!Number.isFinite(view.scale) || view.scale > 1e7) view.scale = 100;
    view.x = width / 2 - (view.scale * (x0 + x1)) / 2;
    view.y = height / 2 + (view.scale * (y0 + y1)) / 2;
    view.fit = false;
  }
  const seen = (k) =>
    Math.max(path.z[k], path.z[k + 1]) >= view.low &&
    Math.min(path.z[k], path.z[k + 1]) <= view.high;

  const draw = canvasOf(canvas, (context, width, height) => {
    if (view.fit) fit(width, height);
    // Lines of one colour are drawn together.
    const groups = new Map(),
      pale = [];
    for (let k = 0; k < count; k++) {
      if (!seen(k)) continue;
      const cause = path.cause[k];
      if (chosen !== null && cause !== chosen) {
        pale.push(k);
        continue;
      }
      const key = view.by === "speed" ? Math.round((path.speed[k] / fastest) * SHADES) : cause;
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(k);
    }
    context.lineCap = context.lineJoin = "round";
    const stroke = (lines, style, wide) => {
      context.strokeStyle = style;
      context.lineWidth = wide;
      context.beginPath();
      let before = -2;
      for (const k of lines) {
        const [[ax, ay], [bx, by]] = [flat[k], flat[k + 1]];
        if (k !== before + 1) context.moveTo(view.x + view.scale * ax, view.y - view.scale * ay);
        context.lineTo(view.x + view.scale * bx, view.y - view.scale * by);
        before = k;
      }
      context.stroke();
    };
    stroke(pale, BACKGROUND, 1.2);
    const wide = count > 6000 ? 1.4 : 2;
    for (const [key, lines] of [...groups].sort((a, b) => a[0] - b[0])) {
      stroke(lines, view.by === "speed" ? ramp(key / SHADES) : causeColour(key), wide);
    }
    mark(context);
    rule(context, width, height);
  });

  function mark(context) {
    if (view.at === null || !flat[view.at + 1]) return;
    const [x, y] = flat[view.at + 1];
    context.beginPath();
    context.arc(view.x + view.scale * x, view.y - view.scale * y, 5, 0, 7);
    context.fillStyle = colour("paper");
    context.strokeStyle = colour("ink");
    context.lineWidth = 2;
    context.fill();
    context.stroke();
  }

  // A rule of a round length, and what is to the right and up.
  function rule(context, width, height) {
    context.fillStyle = context.strokeStyle = colour("soft");
    context.lineWidth = 1.5;
    if (view.side !== "time") {
      const length = roundBelow(140 / view.scale);
      const [left, bottom] = [14, height - 14];
      context.beginPath();
      context.moveTo(left, bottom - 5);
      context.lineTo(left, bottom);
      context.lineTo(left + length * view.scale, bottom);
      context.lineTo(left + length * view.scale, bottom - 5);
      context.stroke();
      context.fillText(`${shown(length)} ${unit}`, left + 6, bottom - 8);
    }
    const ways = { top: [0, 1], front: [0, 2], side: [1, 2] }[view.side];
    const text =
      view.side === "time"
        ? `right: time, up: ${names[0]}`
        : ways
          ? `right: ${names[ways[0]]}, up: ${names[ways[1]]}`
          : names.slice(0, 3).join(", ");
    context.textAlign = "right";
    context.fillText(text, width - 14, height - 14);
    context.textAlign = "left";
  }

  // The end of the line that is nearest to a place of the canvas.
  function nearest(x, y) {
    let [best, least] = [null, 14 * 14];
    for (let k = 0; k < count; k++) {
      if (!seen(k)) continue;
      const ax = view.x + view.scale * flat[k][0],
        ay = view.y - view.scale * flat[k][1];
      const dx = view.x + view.scale * flat[k + 1][0] - ax,
        dy = view.y - view.scale * flat[k + 1][1] - ay;
      const along = Math.min(
        Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0),
        1,
      );
      const off = (ax + along * dx - x) ** 2 + (ay + along * dy - y) ** 2;
      if (off < least) [best, least] = [k, off];
    }
    return best;
  }
  function tell(k) {
    view.at = k;
    if (k !== null) {
      const place = [path.x, path.y, path.z]
        .slice(0, names.length)
        .map((values, i) => `${names[i]} ${shown(values[k + 1])}`);
      const code = source.get(path.line[k]);
      element("path-readout").textContent =
        `${word} ${path.line[k]}${code ? ` (${code})` : ""}: ${place.join(", ")} ${unit}, ` +
        `at ${shown(path.t[k])} s, ${shown(path.speed[k], 4)} ${unit}/s, ` +
        `bound by ${nameOf(path.cause[k])}`;
    }
    showTime(k === null ? null : path.t[k]);
    draw();
  }

  function zoom(by, x, y) {
    view.x = x - (x - view.x) * by;
    view.y = y - (y - view.y) * by;
    view.scale *= by;
    draw();
  }
  const middle = (by) => () => zoom(by, canvas.clientWidth / 2, canvas.clientHeight / 2);
  element("zoom-in").addEventListener("click", middle(1.5));
  element("zoom-out").addEventListener("click", middle(1 / 1.5));
  element("zoom-all").addEventListener("click", () => {
    view.fit = true;
    draw();
  });
  // The wheel zooms when the picture has been clicked, so that the page can be scrolled past it.
  canvas.addEventListener(
    "wheel",
    (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      zoom(Math.exp(-event.deltaY * 0.0015), event.offsetX, event.offsetY);
    },
    { passive: false },
  );

  const held = new Map(); // Fingers, or the mouse button, and where they were.
  canvas.addEventListener("pointerdown", (event) => {
    held.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
  });
  const release = (event) => held.delete(event.pointerId);
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => {
    if (!held.size) tell(null);
  });
  canvas.addEventListener("pointermove", (event) => {
    const now = [event.offsetX, event.offsetY],
      before = held.get(event.pointerId);
    if (!before) {
      tell(nearest(...now));
      return;
    }
    held.set(event.pointerId, now);
    const others = [...held].filter(([id]) => id !== event.pointerId);
    if (others.length) {
      const [x, y] = others[0][1];
      const far = (p) => Math.hypot(p[0] - x, p[1] - y) || 1;
      zoom(far(now) / far(before), x, y);
    } else {
      view.x += now[0] - before[0];
      view.y += now[1] - before[1];
      draw();
    }
  });

  function legend() {
    const box = element("legend");
    box.replaceChildren();
    if (view.by === "speed") {
      const bar = make("span", null, "ramp");
      const shades = RAMP.map((c) => `rgb(${c.join()})`);
      bar.style.background = `linear-gradient(90deg, ${shades.join()})`;
      box.append("0", bar, `${shown(fastest, 4)} ${unit}/s`);
      return;
    }
    const used = new Set(path.cause);
    [...used]
      .sort((a, b) => a - b)
      .forEach((cause) => {
        const swatch = make("span", null, "swatch");
        swatch.style.background = causeColour(cause);
        box.append(make("span", null, "", swatch, nameOf(cause)));
      });
  }
  drawn.push(legend);
  choice(
    "colours",
    [
      ["speed", "speed"],
      ["cause", "what binds"],
    ],
    view.by,
    (key) => {
      view.by = key;
      legend();
      draw();
    },
  );
  const sides =
    view.side === "time"
      ? [["time", "over time"]]
      : path.over.length < 3
        ? [["top", "top"]]
        : [
            ["top", "top"],
            ["front", "front"],
            ["side", "side"],
            ["oblique", "oblique"],
          ];
  choice("sides", sides, view.side, (key) => {
    view.side = key;
    project();
    view.fit = true;
    draw();
  });

  if (path.over.length > 2 && size[2] > 0) {
    const [low, high] = extent(path.z),
      inputs = [element("layer-low"), element("layer-high")];
    const set = () => {
      const ends = inputs.map((input) => low + ((high - low) * input.value) / 1000);
      [view.low, view.high] = [Math.min(...ends) - 1e-9, Math.max(...ends) + 1e-9];
      element("layer-range").textContent =
        `${names[2]} ${shown(Math.min(...ends), 3)} to ${shown(Math.max(...ends), 3)} ${unit}`;
      draw();
    };
    inputs.forEach((input) => input.addEventListener("input", set));
    element("layers").hidden = false;
    set();
  }
}
