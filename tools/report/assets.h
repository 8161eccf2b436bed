// The files of the HTML pages of reports and studies, as texts in the program. assets.cmake writes
// the definitions. The texts of uPlot are empty if its npm package was missing when the build was
// configured.
#pragma once

#include <string_view>

namespace fogline::report::assets {

extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kModelJs;
extern const std::string_view kScrollJs;
extern const std::string_view kChartJs;
extern const std::string_view kLegendJs;
extern const std::string_view kCurvesJs;
extern const std::string_view kFrontJs;
extern const std::string_view kPageJs;
extern const std::string_view kStudyHtml;
extern const std::string_view kStudyCss;
extern const std::string_view kStudyJs;
extern const std::string_view kUplotJs;
extern const std::string_view kUplotCss;
extern const std::string_view kUplotLicense;
extern const std::string_view kUplotVersion;

/// The reason why this build can make no pages; "" if it can.
inline std::string_view WhyNoPages() {
  if (!kUplotJs.empty()) return "";
  return "this build has no charts, because packages of npm were missing when it was configured; "
         "install and build: tools/setup run && tools/build fogline_demo";
}

}  // namespace fogline::report::assets
