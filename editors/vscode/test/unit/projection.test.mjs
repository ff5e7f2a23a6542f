import assert from "node:assert/strict";
import { test } from "node:test";
import { FIRST, ballAround, moved, projection, turned, zoomed } from "../../view/projection.mjs";

const screen = { width: 400, height: 300 };
const ball = ballAround([-1, -1, -1, 1, 1, 1]);
/** From x, on the level of the floor. */
const front = { ...FIRST, yaw: 0, pitch: 0 };

/** @type {(spot: number[]) => number[]} */
const rounded = (spot) => spot.map((value) => Math.round(value * 1000) / 1000 + 0);

test("the ball is around all points", () => {
  assert.deepEqual(ball.centre, [0, 0, 0]);
  assert.equal(ball.radius, Math.sqrt(3));
  assert.equal(ballAround([]).radius, 1);
  assert.ok(ballAround([1, 2, 3]).radius > 0, "one point");
});

test("the centre is in the middle, z goes up, and y goes right as seen from x", () => {
  const project = projection(front, ball, screen);
  assert.deepEqual(rounded(project(0, 0, 0)), [200, 150, 0]);
  const [, up] = project(0, 0, 1);
  const [right, level] = project(0, 1, 0);
  assert.ok(up < 150 && right > 200 && level === 150);
});

test("what is nearer is larger and has less depth", () => {
  const project = projection(front, ball, screen);
  const [near, far] = [project(1, 1, 0), project(-1, 1, 0)];
  assert.ok(near[0] > far[0] && near[2] < far[2]);
});

test("from above, x and y are as on paper", () => {
  const project = projection({ ...front, yaw: -Math.PI / 2, pitch: Math.PI / 2 }, ball, screen);
  const [x, y] = [project(1, 0, 0), project(0, 1, 0)];
  assert.ok(x[0] > 200 && Math.abs(x[1] - 150) < 1e-9);
  assert.ok(y[1] < 150 && Math.abs(y[0] - 200) < 1e-9);
});

test("everything is on the screen at first", () => {
  const project = projection(FIRST, ball, screen);
  for (const corner of [0, 1, 2, 3, 4, 5, 6, 7]) {
    const [x, y] = project(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    assert.ok(x >= 0 && x <= 400 && y >= 0 && y <= 300, `${x}, ${y}`);
  }
});

test("the scene follows a drag, and the eye stays between floor and zenith", () => {
  const before = projection(front, ball, screen)(1, 0, 0);
  const after = projection(turned(front, 0.2, 0.2), ball, screen)(1, 0, 0);
  assert.ok(after[0] > before[0] && after[1] > before[1]);
  assert.equal(turned(front, 0, 9).pitch, Math.PI / 2);
  assert.equal(turned(front, 0, -9).pitch, -Math.PI / 2);
  assert.deepEqual(rounded(projection(moved(front, 5, -7), ball, screen)(0, 0, 0)), [205, 143, 0]);
});

test("zooming keeps what is under the pointer", () => {
  const camera = { ...FIRST, right: 10, down: 20 };
  const [x, y] = projection(camera, ball, screen)(0.3, 0.2, 0.1);
  const closer = zoomed(camera, 2, x - 200, y - 150);
  assert.deepEqual(rounded(projection(closer, ball, screen)(0.3, 0.2, 0.1).slice(0, 2)), rounded([x, y]));
  assert.equal(zoomed(camera, 1e9).zoom, 50);
});
