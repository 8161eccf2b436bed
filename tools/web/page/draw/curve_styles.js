// The style of the chosen curves. It does not use the document.

export const DASHES = [[1, 4], [12, 3, 3, 3, 3, 3], [2, 3], [8, 3, 2, 3], [4, 4], [8, 4], [], [14, 4]];

// A place is an index in DASHES and in the palette. The sensors have the same colours and patterns
// as in the other parts of the page. So their places are the last ones in ORDER: another field gets
// such a place only if no other place is free. The places 0 and 1 come just before the places of
// the sensors, because the colours of 0 and 1 are similar to those of the automation and the human.
const OWN_PLACE = {RADAR: 2, LIDAR: 3};
const ORDER = [6, 5, 7, 4, 0, 1, 2, 3];

/**
 * A place in the palette for each field. The first field of a sensor gets the place of the sensor.
 * Every other field gets the first free place.
 * @param fields at most as many as there are places
 */
export function placesOf(fields) {
  const places = fields.map(({channel}, i) => (
    fields.findIndex((field) => field.channel === channel) === i ? OWN_PLACE[channel] : undefined));
  const free = ORDER.filter((place) => !places.includes(place));
  return places.map((place) => place ?? free.shift());
}
