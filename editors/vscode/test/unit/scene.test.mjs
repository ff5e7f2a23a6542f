import assert from "node:assert/strict";
import { test } from "node:test";
import { mesh, neighbour, scene, segmentsOf } from "../../view/scene.mjs";

test("meshes are 1, 2 or 5 times a power of ten", () => {
  assert.deepEqual([10, 1.2, 3, 0.6].map(mesh), [1, 0.2, 0.5, 0.1]);
});

test("the floor is below the path and the base", () => {
  const path = { segments: [], points: [1, 0.5, 0.8, 1, -0.5, -0.3], power: [100], owner: [0] };
  const { grid, ball } = scene(path);
  assert.ok(grid.every(({ from, to }) => from[2] === -0.3 && to[2] === -0.3));
  assert.ok(grid.some(({ from }) => from[0] < 0) && grid.some(({ to }) => to[0] > 1));
  assert.deepEqual(ball.centre, [0.5, 0, 0.25]);
});

test("no movements: a floor all the same", () => {
  assert.ok(scene({ segments: [], points: [], power: [], owner: [] }).grid.length > 0);
});

test("one segment after the other, around", () => {
  assert.deepEqual([neighbour(-1, 1, 3), neighbour(-1, -1, 3), neighbour(2, 1, 3), neighbour(0, -1, 3)], [0, 2, 0, 2]);
  assert.equal(neighbour(-1, 1, 0), -1);
});

test("a line has all segments that it makes", () => {
  const of = { instruction: "MoveL", t_start_s: 0, duration_s: 1, energy_j: 1, wait: false };
  const at = (/** @type {string} */ file, /** @type {number} */ line) => ({ ...of, file, line });
  const path = { segments: [at("/a", 1), at("/b", 1), at("/a", 2), at("/a", 1)], points: [], power: [], owner: [] };
  assert.deepEqual([...segmentsOf(path, "/a", 1)], [0, 3]);
});
