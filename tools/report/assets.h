// The files of the page, as texts in the program. assets.cmake writes the definitions.
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

}  // namespace fogline::report::assets
