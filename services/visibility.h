// Definition of visibility in fog, for all models that use it.
#pragma once

namespace fogline {

/// ln 20, the product of an extinction coefficient and its meteorological optical range. If an
/// object is as far away as this range, 1/20 (5 %) of its contrast remains (WMO-No. 8;
/// Koschmieder).
inline constexpr double kContrastLog = 2.995732273553991;

/// Extinction coefficient in 1/m of air with this meteorological optical range in m.
constexpr double ExtinctionOf(double visibility_m) { return kContrastLog / visibility_m; }

/// Meteorological optical range in m of air with this extinction coefficient in 1/m.
constexpr double VisibilityOf(double extinction_pm) { return kContrastLog / extinction_pm; }

}  // namespace fogline
