// The style of the chosen curves. It does not use the document.

export const DASHES = [[1, 4], [12, 3, 3, 3, 3, 3], [2, 3], [8, 3, 2, 3], [4, 4], [8, 4], [], [14, 4]];

// The sensors have the same colours and patterns as in the other parts of the page. So the places
// of the sensors are the last ones in ORDER: other fields get them only if no other place is free.
// Just before them are the places whose colours are similar to those of the sides that drive.
const OWN_PLACE = {RADAR: 2, LIDAR: 3};
const ORDER = [6, 5, 7, 4, 0, 1, 2, 3];

/**
 * A place in the palette for each field. The first field of a sensor gets the sensor's place. Every
 * other field gets the first free place. @param fields at most as many as there are places
 */
export function placesOf(fields) {
  const places = fields.map(({channel}, i) => (
    fields.findIndex((field) => field.channel === channel) === i ? OWN_PLACE[channel] : undefined));
  const free = ORDER.filter((place) => !places.includes(place));
  return places.map((place) => place ?? free.shift());
}
