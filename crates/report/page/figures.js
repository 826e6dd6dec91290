// Reads the numbers of the page, and fills in the figures. Every figure is a value of the document
// that `--json` prints: its element names the place in `data-figure` and the value in `data-value`.
"use strict";

const read = (id) => JSON.parse(document.getElementById(id).textContent);
const report = read("document"),
  drawing = read("drawing");
const source = new Map(read("source"));
const program = /program$/.test(report.schema.name);
const plan = report.plan || report;
const limits = program ? plan : plan.limits;
const unit = drawing.axes[drawing.path.over[0]].unit;
const word = program ? "line" : "move";

const element = (id) => document.getElementById(id);

// Makes an element with a text, a class and children.
function make(tag, text, kind, ...children) {
  const made = document.createElement(tag);
  if (text !== undefined && text !== null) made.textContent = text;
  if (kind) made.className = kind;
  made.append(...children);
  return made;
}

// A number with as many digits as a reader needs: five, or all of a whole number.
function shown(value, digits = 5) {
  if (value === null || value === undefined) return "-";
  if (Number.isInteger(value)) return value.toLocaleString("en").replace(/,/g, "\u202f");
  const text = Number(value.toPrecision(digits)).toString();
  return text.replace("-", "\u2212");
}

// The value of the document at a pointer such as /plan/total_s.
const value = (pointer) =>
  pointer
    .split("/")
    .slice(1)
    .reduce((at, key) => (at === undefined || at === null ? at : at[key]), report);

// An element that shows a value of the document, divided by `per`, with so many digits.
function figure(pointer, per = 1, digits = 5) {
  const found = value(pointer);
  const made = make("span", shown(typeof found === "number" ? found / per : found, digits));
  made.dataset.figure = pointer;
  made.dataset.value = JSON.stringify(found);
  made.dataset.per = per;
  return made;
}

function card(label, unitText, ...parts) {
  const text = make("dd", null, "", ...parts);
  if (unitText) text.append(make("small", ` ${unitText}`));
  const made = make("div", null, "", make("dt", label), text);
  element("figures").append(made);
  return made;
}

const under = (key) => (report.plan ? `/plan/${key}` : program ? `/${key}` : `/limits/${key}`);

function fillHead() {
  element("command").textContent = report.check ? "simulate" : "plan";
  const passed = report.passed;
  const verdict = report.check ? (passed ? "all holds" : "failed") : "planned within all limits";
  element("verdict").append(make("span", verdict, passed ? "good" : "bad"));
  const axes = (report.check && report.check.axes) || [];
  const failures =
    (report.check && report.check.failures) || axes.flatMap((axis) => axis.failures || []);
  failures.slice(0, 20).forEach((failure) => element("failures").append(make("li", failure)));

  card("time", "s", figure(under("total_s")));
  if (program) {
    card("path", "mm", figure(under("distance_mm")));
    card("lines of the program", "", figure(under("lines")));
    card("moves", "", figure(under("moves")));
    card("runs from rest to rest", "", figure(under("runs")));
    card("segments of an axis", "", figure(under("rows")));
    const [least, most] = [under("tolerance_min_mm"), under("tolerance_max_mm")];
    if (value(least) !== null) {
      const parts =
        value(least) === value(most) ? [figure(least)] : [figure(least), " to ", figure(most)];
      card("tolerance", "mm", ...parts);
    }
    if (report.check) {
      const [most, bound] = ["/check/deviation_mm", "/check/deviation_bound_mm"].map((at) =>
        figure(at, 1, 3),
      );
      card("greatest distance from the path", "mm", most, make("small", " of "), bound).className =
        "broad";
    }
  } else if ("moves" in report) {
    card("moves", "", figure("/moves"));
  }
  if (report.check) {
    axes.forEach((axis, k) => {
      const key = "pulses" in axis ? "pulses" : "pulses_found";
      card(`pulses of ${axis.axis}`, "", figure(`/check/axes/${k}/${key}`));
    });
  }
}

function fillNotes() {
  const { path, charts, lines } = drawing;
  const note = (text) => element("notes").append(make("li", text));
  const strokes = path.line.length,
    stretches = charts.cause.length;
  note(
    `Path: ${shown(strokes)} straight lines stand for ${shown(path.rows)} pieces of the planned ` +
      `motion. The motion is at most ${shown(path.off, 2)} ${unit} away from its line. The ` +
      "colour is the mean speed of a line.",
  );
  note(
    `Charts: the time is divided into ${shown(stretches)} stretches of ` +
      `${shown(charts.seconds * 1000)} ms. The band of a stretch reaches from its least to its ` +
      "greatest value; both are exact.",
  );
  if (lines.together > 1) {
    note(`The file is long: ${lines.together} neighbouring ${word}s are counted together.`);
  }
  note("Speed, acceleration and jerk are those of the integers that the hardware runs.");
  if (program) {
    note(
      "What binds is decided for each segment: the feed or an axis' speed from 98 % on; the " +
        "tolerance where the curve rounds a sharp corner; otherwise an axis' acceleration or " +
        "jerk. Ramps to and from a rest belong to the stop.",
    );
    plan.not_done.forEach((one) =>
      note(`Not done: ${one.what} (${one.count}, first in line ${one.line}): ${one.instead}.`),
    );
    note("Backlash and errors of the screws are not compensated.");
  } else {
    note(
      "What binds is decided for each part of a move: an axis' speed from 98 % of its limit on, " +
        "otherwise the acceleration or jerk that is nearest to its limit, or the time that the " +
        "file gives.",
    );
  }
}
