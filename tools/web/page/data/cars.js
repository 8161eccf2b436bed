// Computes the cars on the road at a moment, from the messages of a step. It draws nothing.

// If a car brakes without its brake pedal, its brake lamps may shine from 0.7 m/s2 of deceleration
// on, and must shine from 1.3 m/s2 on (UN R13-H, 5.2.22.4). The page uses the first value.
export const BRAKE_LAMPS_FROM_MPS2 = 0.7;
const STANDSTILL_MPS = 0.1;  // slower than a person walks; our choice
const CONTRAST_AT_VISIBILITY = 0.05;  // by the definition of the meteorological optical range

/** Extinction in 1/m for a visibility in m, by Koschmieder's law. */
export function extinction(visibility_m) {
  return visibility_m > 0 ? -Math.log(CONTRAST_AT_VISIBILITY) / visibility_m : 0;
}

const brakes = (acceleration_mps2) => acceleration_mps2 <= -BRAKE_LAMPS_FROM_MPS2;

/**
 * All cars, the foremost first: [{name, kind, front_m, speed_mps, brakes}]. front_m is the position
 * of the front bumper relative to the host's front bumper. `ahead_s` is the time since the step.
 * The cars drive on at their speeds for this time. It is so short that no car passes another car.
 */
export function carsOf(truth, ahead_s = 0) {
  const place = (position_m, speed_mps) =>
    position_m - truth.host_position_m + ahead_s * (speed_mps - truth.host_speed_mps);
  const car = (name, kind, position_m, speed_mps, acceleration_mps2) => (
    {name, kind, front_m: place(position_m, speed_mps), speed_mps,
     brakes: brakes(acceleration_mps2)});
  return [
    car("preceding car", "preceding", truth.preceding_position_m, truth.preceding_speed_mps,
        truth.preceding_acceleration_mps2),
    car("host", "host", truth.host_position_m, truth.host_speed_mps, truth.host_acceleration_mps2),
    ...truth.follower_position_m.map((position_m, i) =>
      car(truth.num_followers > 1 ? `following car ${i + 1}` : "following car", "follower",
          position_m, truth.follower_speed_mps[i], truth.follower_acceleration_mps2[i])),
  ];
}

/**
 * The distance ahead of the host, in m, at which each sensor sees the preceding car; null for a
 * sensor that does not see it.
 */
export function sightings({RADAR, LIDAR, TRACK}) {
  return {
    radar: RADAR?.valid ? RADAR.range_m : null,
    lidar: LIDAR?.valid ? LIDAR.range_m : null,
    fusion: TRACK?.valid ? TRACK.state[0] : null,
  };
}

/** Whether the host stands (STANDSTILL_MPS). A time gap then has no meaning. */
export const stands = (truth) => Boolean(truth) && truth.host_speed_mps <= STANDSTILL_MPS;

/** Time in s that the host needs for the gap at its speed; null at a standstill. */
export function timeGap(truth) {
  return stands(truth) ? null : truth.host_gap_m / truth.host_speed_mps;
}
