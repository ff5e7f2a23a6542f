import assert from "node:assert/strict";
import { test } from "node:test";
import { colour, range, share } from "../../view/colour.mjs";

test("the range of powers", () => {
  assert.deepEqual(range([300, -20, 1000]), { least: -20, most: 1000 });
  assert.deepEqual(range([]), { least: 0, most: 0 });
});

test("shares are within the range", () => {
  const of = { least: 200, most: 400 };
  assert.deepEqual([100, 200, 250, 400, 500].map((power) => share(power, of)), [0, 0, 0.25, 1, 1]);
  assert.equal(share(5, { least: 5, most: 5 }), 0, "constant power");
});

/** @param {string} text */
const brightness = (text) => {
  const [red, green, blue] = (text.match(/\d+/g) ?? []).map(Number);
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
};

test("more power is farther from the background", () => {
  assert.equal(colour(0, "dark"), "rgb(84, 112, 240)");
  assert.equal(colour(1, "light"), "rgb(120, 20, 8)");
  assert.ok(brightness(colour(1, "dark")) > brightness(colour(0, "dark")));
  assert.ok(brightness(colour(1, "light")) < brightness(colour(0, "light")));
});
