// A page of the report in headless Chromium. Each test adds a script to a copy of the page. The
// script writes its findings into an attribute, which Chromium prints with the rest of the page.
#pragma once

#include <chrono>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"
#include "tools/report/html.h"

namespace fogline {

struct ViewSize {
  int width;
  int height;
};
/// The colour scheme that the reader prefers, with Chromium's numbers.
enum class Scheme { kDark = 0, kLight = 1 };

inline constexpr ViewSize kDesktop{1280, 900};
inline constexpr ViewSize kPhone{360, 740};

/// The page in a frame of the wanted size, because a window of Chromium is at least 500 pixels
/// wide. Chromium prints the page only when all documents are loaded. The document of the frame
/// `hold` is opened and stays unfinished, so it delays the printing. The last statement of kProbe
/// closes this document.
inline constexpr std::string_view kFrame = R"(<!DOCTYPE html><body style="margin:0">
<iframe id="hold" hidden></iframe>
<script>document.getElementById("hold").contentDocument.open();</script>
<iframe style="border:0;width:{}px;height:{}px" srcdoc="{}"></iframe>)";

/// This script runs before all other scripts of the page, and collects the page's errors.
inline constexpr std::string_view kWatch = R"(<script>
const problems = [];
addEventListener("error", (event) => problems.push(event.message));
addEventListener("unhandledrejection", (event) => problems.push(String(event.reason)));
addEventListener("securitypolicyviolation", (event) => problems.push(event.violatedDirective));
console.error = (...what) => problems.push(what.join(" "));
</script>)";

/// This script runs after all other scripts of the page. It contains the script of the test.
inline constexpr std::string_view kProbe = R"(<script>
const frame = () => new Promise(requestAnimationFrame);
const settled = async () => {{ for (let i = 0; i < 5; ++i) await frame(); }};
const isDrawn = (canvas) => canvas.width > 0 &&
    canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((v) => v > 0);
const canvases = () => [...document.querySelectorAll("figure canvas")];
const curveCanvases = () => [...document.querySelectorAll("#curves canvas")];
const mouse = (type, element, x, y = 40) => {{
  const {{left, top}} = element.getBoundingClientRect();
  element.dispatchEvent(new MouseEvent(type, {{bubbles: true, button: 0, clientX: left + x,
                                              clientY: top + y, movementX: 5, movementY: 1}}));
}};
const pointer = (index, x) => mouse("mousemove", page.charts[index].over, x);
const click = (selector) => document.querySelector(selector).click();
(async () => {{
  await settled();
  const found = {{}};
  try {{
    {}
  }} catch (problem) {{
    problems.push(String(problem));
  }}
  await settled();
  found.problems = problems;
  found.loaded = performance.getEntriesByType("resource").length;
  top.document.documentElement.dataset.found = JSON.stringify(found);
  top.document.getElementById("hold").contentDocument.close();
}})();
</script>)";

inline std::string Replaced(std::string text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
  return text;
}

class BrowserTest : public ::testing::Test {
 protected:
  /// Shows a page in a window and runs `script`. @return the object `found` of the script. Its
  /// member "problems" has the errors of the page. Its member "loaded" is the number of resources
  /// from outside
  nlohmann::json Show(std::string report, ViewSize window, std::string_view script,
                      Scheme scheme = Scheme::kLight) {
    report.insert(report.find("<meta"), kWatch);
    report.insert(report.rfind("</body>"), fmt::format(kProbe, script));
    const std::string file = folder_.File("page.html");
    std::ofstream(file) << fmt::format(kFrame, window.width, window.height,
                                       report::EscapeHtml(report));
    const test::Outcome outcome = test::RunCommand(
        {FOGLINE_CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
         "--no-first-run", "--disable-background-networking", "--disable-component-update",
         "--disable-sync", "--user-data-dir=" + folder_.File("profile"),
         fmt::format("--window-size={},{}", window.width, window.height),
         fmt::format("--blink-settings=preferredColorScheme={}", static_cast<int>(scheme)),
         "--dump-dom", "file://" + file},
        test::kPatience);
    return Found(outcome.out);
  }

 private:
  static nlohmann::json Found(const std::string& shown) {
    constexpr std::string_view kAttribute = "data-found=\"";
    const std::size_t begin = shown.find(kAttribute);
    if (begin == std::string::npos) {
      ADD_FAILURE() << "the page's script did not come to its end";
      return {{"problems", {"no result"}}};
    }
    const std::size_t from = begin + kAttribute.size();
    std::string text = shown.substr(from, shown.find('"', from) - from);
    for (const auto& [entity, character] :
         {std::pair{"&quot;", "\""}, {"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}}) {
      text = Replaced(text, entity, character);
    }
    return nlohmann::json::parse(text);
  }

  test::ScratchFolder folder_;
};

}  // namespace fogline
