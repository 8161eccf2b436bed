// Colours for the canvases, from the style sheet.

const NAMES = [
  "page", "surface", "line", "ink", "muted", "grid", "accent", "fog", "automation", "human", "risk",
  "radar", "lidar", "asphalt", "verge", "marking", "car", "lamp", "haze",
  "p0", "p1", "p2", "p3", "p4", "p5", "p6", "p7",
];

/** {ink: "#1b2127", ..., palette: [...], font: "..."} for the reader's colour scheme. */
export function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const theme = Object.fromEntries(
    NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
  theme.palette = Array.from({length: 8}, (_, i) => theme[`p${i}`]);
  theme.font = getComputedStyle(document.body).fontFamily;
  return theme;
}

/** "#rrggbb" with an opacity from 0 to 1. */
export function withAlpha(colour, alpha) {
  return colour + Math.round(alpha * 255).toString(16).padStart(2, "0");
}
