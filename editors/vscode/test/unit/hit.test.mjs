import assert from "node:assert/strict";
import { test } from "node:test";
import { distance, hit } from "../../view/hit.mjs";

test("the distance to a piece, to its ends, and to a dot", () => {
  assert.equal(distance(5, 3, [0, 0, 0], [10, 0, 0]), 3);
  assert.equal(distance(13, 4, [0, 0, 0], [10, 0, 0]), 5);
  assert.equal(distance(3, 4, [0, 0, 0], [0, 0, 0]), 5);
});

test("the nearest piece within reach", () => {
  /** @type {import("../../view/projection.mjs").Spot[]} */
  const spots = [
    [0, 0, 0],
    [100, 0, 0],
    [100, 100, 0],
  ];
  assert.equal(hit(spots, 50, 4, 10), 0);
  assert.equal(hit(spots, 96, 50, 10), 1);
  assert.equal(hit(spots, 50, 50, 10), -1);
  assert.equal(hit([], 50, 50, 10), -1);
});

test("of two pieces at one place, the one in front", () => {
  /** @type {import("../../view/projection.mjs").Spot[]} */
  const spots = [
    [0, 0, 2],
    [100, 0, 2],
    [100, 0, -2],
    [0, 0, -2],
  ];
  assert.equal(hit(spots, 50, 1, 10), 2);
});
