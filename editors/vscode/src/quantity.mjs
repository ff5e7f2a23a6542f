// Quantities as text.

/**
 * Three digits, with a unit that fits.
 * @param {number} value
 * @param {string} unit
 */
function scaled(value, unit) {
  const [factor, prefix] = Math.abs(value) >= 999.5 ? [1000, "k"] : [1, ""];
  const shown = value / factor;
  const size = Math.abs(shown);
  return `${shown.toFixed(size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2)} ${prefix}${unit}`;
}

/** @param {number} value J */
export const joules = (value) => scaled(value, "J");

/** @param {number} value s */
export const seconds = (value) => `${value.toFixed(value >= 9.995 ? 1 : 2)} s`;

/** @param {number} value W */
export const watts = (value) => `${Math.round(value)} W`;
