// Canvases that are sharp on every screen, follow the theme, and are drawn again when either
// changes; and the colours of speeds and causes.

const styles = () => getComputedStyle(document.documentElement);
const colour = (name) => styles().getPropertyValue(`--${name}`).trim();
const isDark = matchMedia("(prefers-color-scheme: dark)");

const drawn = []; // Functions that draw everything again.
function redraw() {
  drawn.forEach((draw) => draw());
}

// Calls `draw(context, width, height)` now and whenever the canvas has to be drawn again.
function canvasOf(canvas, draw) {
  const again = () => {
    const { clientWidth: width, clientHeight: height } = canvas;
    const dense = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(width * dense));
    canvas.height = Math.max(1, Math.round(height * dense));
    const context = canvas.getContext("2d");
    context.scale(dense, dense);
    context.font = "12px system-ui, 'DejaVu Sans', sans-serif";
    draw(context, width, height);
  };
  drawn.push(again);
  return again;
}

// Slow is blue, fast is red. Each entry is a part of the way and a colour.
const RAMP = [
  [59, 76, 192],
  [42, 160, 184],
  [82, 170, 72],
  [233, 162, 39],
  [212, 61, 47],
];
function ramp(part) {
  const at = Math.min(Math.max(part, 0), 1) * (RAMP.length - 1);
  const k = Math.min(Math.floor(at), RAMP.length - 2),
    rest = at - k;
  return `rgb(${RAMP[k].map((low, i) => Math.round(low + rest * (RAMP[k + 1][i] - low))).join()})`;
}

function causeColour(number) {
  const { cause, axis } = drawing.causes[number];
  const light = isDark.matches ? 8 : 0;
  const of = (hue, step, full, bright) => `hsl(${hue + step * axis} ${full}% ${bright + light}%)`;
  switch (cause) {
    case "stop":
      return isDark.matches ? "#8b95a1" : "#7b8591";
    case "given_time":
      return isDark.matches ? "#5e6a78" : "#b3bac3";
    case "feed":
      return isDark.matches ? "#4cc38a" : "#219a64";
    case "tolerance":
      return isDark.matches ? "#b58cf0" : "#8450d0";
    case "speed":
      return of(200, 13, 78, 44);
    case "acceleration":
      return of(14, 14, 84, 50);
    default:
      return of(322, 12, 62, 50);
  }
}

// What a cause is called: "acceleration of x".
function causeName(cause, axis) {
  const name =
    {
      given_time: "the time that the file gives",
      tolerance: "tolerance, at corners",
      stop: "stops",
    }[cause] || cause;
  return axis === null || axis === undefined ? name : `${name} of ${axis}`;
}
const nameOf = (number) => {
  const { cause, axis } = drawing.causes[number];
  return causeName(cause, axis === null ? null : drawing.axes[axis].name);
};
const numberOf = (cause, axis) =>
  drawing.causes.findIndex(
    (one) =>
      one.cause === cause && (one.axis === null ? null : drawing.axes[one.axis].name) === axis,
  );

// The cause that the reader has chosen; the others are drawn pale.
let chosen = null;
function choose(number) {
  chosen = chosen === number ? null : number;
  document.querySelectorAll("#causes tbody tr").forEach((row) => {
    row.classList.toggle("chosen", Number(row.dataset.cause) === chosen);
  });
  redraw();
}

// Buttons of which one is pressed.
function choice(id, names, pressed, change) {
  const buttons = names.map(([key, text]) => {
    const button = make("button", text);
    button.type = "button";
    button.addEventListener("click", () => set(key));
    button.dataset.key = key;
    return button;
  });
  function set(key) {
    buttons.forEach((button) => button.setAttribute("aria-pressed", button.dataset.key === key));
    change(key);
  }
  element(id).append(...buttons);
  buttons.forEach((button) => button.setAttribute("aria-pressed", button.dataset.key === pressed));
}

// The greatest of 1, 2, 5, 10, 20 ... that is not over a value.
function roundBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return Number(([5, 2, 1].find((k) => k * power <= value) * power).toPrecision(6));
}

// Round places for about `count` ticks between two values.
function ticks(low, high, count) {
  const rough = (high - low) / Math.max(count, 1);
  if (!(rough > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((step) => step >= rough) || 10 * power;
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9; k++)
    found.push(Number((k * step).toPrecision(12)));
  return found;
}
