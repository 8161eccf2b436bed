// The look of the chosen curves. It knows no document.

export const DASHES = [[], [8, 4], [2, 3], [8, 3, 2, 3], [14, 4], [4, 4], [1, 4], [12, 3, 3, 3, 3, 3]];

// The sensors have the same colours and patterns as in the other parts of the page, so the other
// fields take their places last.
const OWN_PLACE = {RADAR: 2, LIDAR: 3};
const ORDER = [0, 1, 4, 5, 6, 7, 2, 3];

/**
 * A place in the palette for each field: the first field of a sensor has the sensor's place, and
 * every other field the first free one. @param fields at most as many as there are places
 */
export function placesOf(fields) {
  const places = fields.map(({channel}, i) => (
    fields.findIndex((field) => field.channel === channel) === i ? OWN_PLACE[channel] : undefined));
  const free = ORDER.filter((place) => !places.includes(place));
  return places.map((place) => place ?? free.shift());
}
