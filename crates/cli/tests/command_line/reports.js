// Uses a page as a reader does, with mouse, wheel and buttons. Each entry of `found` has to be true.
const found = [],
  canvas = element("path"),
  box = canvas.getBoundingClientRect();
const pointer = (kind, x, y) =>
  canvas.dispatchEvent(
    new PointerEvent(kind, {
      clientX: box.left + x,
      clientY: box.top + y,
      pointerId: 7,
      bubbles: true,
    }),
  );
const inked = () => {
  const copy = Object.assign(document.createElement("canvas"), {
    width: canvas.width,
    height: canvas.height,
  });
  const context = copy.getContext("2d", { willReadFrequently: true });
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  let count = 0;
  for (let k = 3; k < data.length; k += 4) count += data[k] > 0;
  return count;
};
const view = () => [pathView.x, pathView.y, pathView.scale];
const whole = inked(),
  begun = view();
found.push(whole > 500);
pointer("pointerdown", 100, 100);
pointer("pointermove", 130, 90);
pointer("pointerup", 130, 90);
found.push(view()[0] - begun[0] === 30, view()[1] - begun[1] === -10);
canvas.dispatchEvent(
  new WheelEvent("wheel", { deltaY: -500, ctrlKey: true, clientX: box.left, clientY: box.top }),
);
found.push(view()[2] > 1.5 * begun[2]);
element("zoom-all").click();
found.push(Math.abs(view()[2] / begun[2] - 1) < 1e-9);
const { path } = drawing,
  k = Math.floor(path.x.length / 3);
pointer(
  "pointermove",
  pathView.x + pathView.scale * path.x[k],
  pathView.y - pathView.scale * path.y[k],
);
found.push(/^line \d+ \(.*\): x .* mm\/s, bound by /.test(element("path-readout").textContent));
pointer("pointerleave", 0, 0);
const high = element("layer-high");
high.value = 400;
high.dispatchEvent(new Event("input"));
found.push(inked() < 0.8 * whole);
high.value = 1000;
high.dispatchEvent(new Event("input"));
document.querySelector("#colours [data-key=cause]").click();
found.push(element("legend").textContent.includes("feed"));
document.querySelector("#causes tbody tr").click();
found.push(chosen === Number(document.querySelector("#causes tr.chosen").dataset.cause));
document.querySelector("#sides [data-key=front]").click();
found.push(pathView.side === "front" && inked() > 300);
const chartBox = document.querySelector(".chart").getBoundingClientRect();
const drag = (kind, x) =>
  document
    .querySelector(".chart")
    .dispatchEvent(
      new PointerEvent(kind, {
        clientX: chartBox.left + x,
        clientY: chartBox.top + 20,
        pointerId: 8,
      }),
    );
drag("pointerdown", 300);
drag("pointermove", 500);
drag("pointerup", 500);
found.push(time.from > 0.1 * time.whole && time.to < 0.6 * time.whole);
element("time-all").click();
found.push(time.from === 0 && time.to === time.whole);
document.documentElement.dataset.found = found.join();
