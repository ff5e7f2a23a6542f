import assert from "node:assert/strict";
import { resolve } from "node:path";
import { test } from "node:test";
import { segments, thin } from "../../src/trajectory.mjs";

const HEAD = "t,q1,p_mech,p_elec,tcp_x,tcp_y,tcp_z,tcp_speed,file,line";

/** @type {(line: number, t_start_s: number, duration_s: number) => import("../../src/trajectory.mjs").Action} */
const action = (line, t_start_s, duration_s) => ({
  file: "a.mod",
  line,
  instruction: "MoveL",
  t_start_s,
  duration_s,
  energy_j: 1,
});

test("movements and waits are in the order of time, without those that take none", () => {
  const found = segments({ moves: [action(1, 0, 1), action(3, 3, 0), action(4, 3, 1)], waits: [action(2, 1, 2)] }, "/cell");
  assert.deepEqual(
    found.map(({ line, wait }) => [line, wait]),
    [
      [1, false],
      [2, true],
      [4, false],
    ],
  );
  assert.equal(found[0].file, resolve("/cell", "a.mod"));
});

/** One second along x with 1 m/s, then one at rest; the power rises, then it is constant. */
function samples() {
  const rows = [HEAD];
  for (let k = 0; k <= 1000; k += 1) {
    const t = k * 0.002;
    rows.push([t, 0, 0, t < 1 ? 400 * t : 200, Math.min(t, 1), 0, 0.5, 1, "a,b.mod", 1].join(","));
  }
  return rows;
}

test("pieces keep the energy and the ends of the segments", async () => {
  const actions = segments({ moves: [action(1, 0, 1)], waits: [action(2, 1, 1)] }, "/");
  const path = await thin(samples(), actions);
  assert.equal(path.points.length, 3 * (path.power.length + 1));
  assert.ok(path.power.length > 100 && path.power.length < 130, `${path.power.length} pieces`);
  assert.deepEqual(path.owner.filter((owner) => owner === 1).length, 1, "a wait is one piece");
  assert.ok(Math.abs((path.power.at(-1) ?? 0) - 200) < 1, "the power of the wait");
  assert.deepEqual(path.points.slice(-6), [1, 0, 0.5, 1, 0, 0.5]);
  const moving = path.power.slice(0, -1);
  assert.ok(moving.every((power, k) => k === 0 || k + 1 === moving.length || power > moving[k - 1]));
});

test("a program without movements has no pieces", async () => {
  assert.deepEqual(await thin([HEAD], []), { segments: [], points: [], power: [], owner: [] });
  const { points, power } = await thin([HEAD, "0,0,0,200,1,2,3,0,a.mod,1"], []);
  assert.deepEqual({ points, power }, { points: [1, 2, 3], power: [] });
});
