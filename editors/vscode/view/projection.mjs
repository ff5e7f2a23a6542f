// From points in space to points on the screen.

/**
 * @typedef {object} Camera
 * @property {number} yaw where the eye is, around the vertical axis from x to y, rad
 * @property {number} pitch where the eye is, above the floor, rad
 * @property {number} zoom 1: everything fits
 * @property {number} right how far the picture is moved, px
 * @property {number} down px
 *
 * @typedef {{ centre: [number, number, number], radius: number }} Ball what has to be seen, m
 * @typedef {[x: number, y: number, depth: number]} Spot px, px, and m behind the centre
 */

/** The eye is so many radii away from the centre. */
const DISTANCE = 4;
/** The radius in the smaller side of the screen. */
const FIT = 0.48;
/** Of the ball around a single point, m. */
const MIN_RADIUS = 0.05;
const MAX_PITCH = Math.PI / 2;
const ZOOM = { min: 0.2, max: 50 };

/** @type {Readonly<Camera>} */
export const FIRST = { yaw: -0.9, pitch: 0.5, zoom: 1, right: 0, down: 0 };

/**
 * The ball around points, with the centre of their smallest box.
 * @param {number[]} points x, y, z of each
 * @returns {Ball}
 */
export function ballAround(points) {
  const least = [Infinity, Infinity, Infinity];
  const most = [-Infinity, -Infinity, -Infinity];
  points.forEach((value, index) => {
    least[index % 3] = Math.min(least[index % 3], value);
    most[index % 3] = Math.max(most[index % 3], value);
  });
  if (points.length === 0) {
    return { centre: [0, 0, 0], radius: 1 };
  }
  const [x, y, z] = least.map((low, axis) => (low + most[axis]) / 2);
  let radius = MIN_RADIUS;
  for (let at = 0; at < points.length; at += 3) {
    radius = Math.max(radius, Math.hypot(points[at] - x, points[at + 1] - y, points[at + 2] - z));
  }
  return { centre: [x, y, z], radius };
}

/**
 * @param {Camera} camera
 * @param {Ball} ball
 * @param {{ width: number, height: number }} screen px
 * @returns {(x: number, y: number, z: number) => Spot}
 */
export function projection({ yaw, pitch, zoom, right, down }, { centre, radius }, { width, height }) {
  const [sinYaw, cosYaw] = [Math.sin(yaw), Math.cos(yaw)];
  const [sinPitch, cosPitch] = [Math.sin(pitch), Math.cos(pitch)];
  const eye = DISTANCE * radius;
  const scale = (zoom * FIT * Math.min(width, height)) / radius;
  return (x, y, z) => {
    const [dx, dy, dz] = [x - centre[0], y - centre[1], z - centre[2]];
    const outward = cosYaw * dx + sinYaw * dy;
    const depth = -(cosPitch * outward + sinPitch * dz);
    // What is behind the eye stays at its plane.
    const nearer = (scale * eye) / Math.max(eye + depth, 0.01 * eye);
    const sideways = cosYaw * dy - sinYaw * dx;
    const upward = cosPitch * dz - sinPitch * outward;
    return [width / 2 + right + nearer * sideways, height / 2 + down - nearer * upward, depth];
  };
}

/** @param {number} value @param {number} min @param {number} max */
const clamp = (value, min, max) => Math.min(max, Math.max(min, value));

/**
 * The scene follows the pointer: the eye goes the other way.
 * @param {Camera} camera
 * @param {number} right rad
 * @param {number} down rad
 * @returns {Camera}
 */
export function turned(camera, right, down) {
  return { ...camera, yaw: camera.yaw - right, pitch: clamp(camera.pitch + down, -MAX_PITCH, MAX_PITCH) };
}

/**
 * @param {Camera} camera
 * @param {number} right px
 * @param {number} down px
 * @returns {Camera}
 */
export function moved(camera, right, down) {
  return { ...camera, right: camera.right + right, down: camera.down + down };
}

/**
 * The point under the pointer stays there.
 * @param {Camera} camera
 * @param {number} factor
 * @param {number} x of the pointer from the middle of the screen, px
 * @param {number} y px
 * @returns {Camera}
 */
export function zoomed(camera, factor, x = 0, y = 0) {
  const zoom = clamp(camera.zoom * factor, ZOOM.min, ZOOM.max);
  const real = zoom / camera.zoom;
  return { ...camera, zoom, right: x - (x - camera.right) * real, down: y - (y - camera.down) * real };
}
