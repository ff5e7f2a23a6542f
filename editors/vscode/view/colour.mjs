// Colours for powers.

/** @typedef {[red: number, green: number, blue: number]} Colour */
/** @typedef {{ least: number, most: number }} Range W */

/**
 * From least to most power: away from the background, which is dark or light.
 * @type {{ dark: Colour[], light: Colour[] }}
 */
const STOPS = {
  dark: [
    [84, 112, 240],
    [176, 92, 208],
    [242, 100, 118],
    [255, 196, 76],
  ],
  light: [
    [100, 146, 246],
    [150, 84, 204],
    [208, 44, 96],
    [120, 20, 8],
  ],
};

/**
 * @param {number[]} powers
 * @returns {Range}
 */
export function range(powers) {
  if (powers.length === 0) {
    return { least: 0, most: 0 };
  }
  return powers.reduce(
    ({ least, most }, power) => ({ least: Math.min(least, power), most: Math.max(most, power) }),
    { least: Infinity, most: -Infinity },
  );
}

/**
 * Where a power is between the least (0) and the most (1).
 * @param {number} power
 * @param {Range} of
 */
export function share(power, { least, most }) {
  return most > least ? Math.min(1, Math.max(0, (power - least) / (most - least))) : 0;
}

/**
 * @param {number} at 0 to 1
 * @param {"dark" | "light"} theme
 */
export function colour(at, theme) {
  const stops = STOPS[theme];
  const place = at * (stops.length - 1);
  const index = Math.min(Math.floor(place), stops.length - 2);
  const mixed = stops[index].map((from, channel) =>
    Math.round(from + (stops[index + 1][channel] - from) * (place - index)),
  );
  return `rgb(${mixed.join(", ")})`;
}
