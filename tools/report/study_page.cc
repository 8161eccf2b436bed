#include "tools/report/study_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <boost/algorithm/string/replace.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/report/assets.h"
#include "tools/report/html.h"

namespace fogline::report {
namespace {

using nlohmann::json;

// Significant digits of the numbers in drawings. More digits would not be visible.
constexpr int kDigits = 6;

json Numbers(const std::vector<double>& values) {
  json numbers = json::array();
  for (const double value : values) {
    // The number is printed and read again, so that it has only kDigits digits.
    numbers.push_back(std::isfinite(value) ? json(std::stod(fmt::format("{:.{}g}", value, kDigits)))
                                           : json(nullptr));
  }
  return numbers;
}

json FigureData(const StudyFigure& figure) {
  json series = json::array();
  for (const StudySeries& one : figure.series) {
    series.push_back({{"name", one.name},
                      {"x", Numbers(one.x)},
                      {"y", Numbers(one.y)},
                      {"low", Numbers(one.low)},
                      {"high", Numbers(one.high)},
                      {"shown", one.shown}});
  }
  return {{"id", figure.id},
          {"xLabel", figure.x_label},
          {"categories", figure.categories},
          {"logX", figure.log_x},
          {"logY", figure.log_y},
          {"most", Numbers({figure.most})[0]},
          {"series", std::move(series)}};
}

/// A note for the reader on the scale of the y axis; "" for a plain axis.
std::string ScaleText(const StudyFigure& figure) {
  if (figure.log_y) return " <span class=\"unit\">(logarithmic)</span>";
  if (!std::isfinite(figure.most)) return "";
  return fmt::format(" <span class=\"unit\">(▸ beyond {:g})</span>", figure.most);
}

std::string Row(const std::vector<std::string>& cells, std::string_view first,
                std::string_view rest) {
  std::string row = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view tag = i == 0 ? first : rest;
    row += fmt::format("<{}>{}</{}>", tag, EscapeHtml(cells[i]), tag.substr(0, 2));
  }
  return row + "</tr>\n";
}

std::string ScrollingTable(std::string_view caption, const std::string& head,
                           const std::string& body) {
  return fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}\"><table><thead>{}"
      "</thead><tbody>\n{}</tbody></table></div>\n",
      EscapeHtml(caption), head, body);
}

std::string TableElement(const StudyTable& table) {
  std::string body;
  for (const std::vector<std::string>& row : table.rows) body += Row(row, "th scope=\"row\"", "td");
  return ScrollingTable(table.caption, Row(table.columns, "th scope=\"col\"", "th scope=\"col\""),
                        body);
}

std::string Folded(std::string_view kind, std::string_view summary, std::string_view content) {
  return fmt::format("<details class=\"{}\"><summary>{}</summary>\n{}</details>\n", kind,
                     EscapeHtml(summary), content);
}

/// A text such as "9 of 9 claims hold", with the numbers of claims that fail or are open.
std::string ClaimsText(const std::vector<StudyClaim>& claims) {
  const auto count = [&](ClaimState state) {
    return std::ranges::count(claims, state, &StudyClaim::state);
  };
  std::string text = fmt::format("{} of {} claims hold", count(ClaimState::kHolds), claims.size());
  if (const auto fail = count(ClaimState::kFails)) text += fmt::format(", {} fail", fail);
  if (const auto open = count(ClaimState::kOpen)) {
    text += fmt::format(", {} are open because of too few runs", open);
  }
  return text;
}

constexpr std::array<std::string_view, 5> kClaimColumns{"claim", "compared", "expected", "found",
                                                        "state"};

std::vector<std::string> CellsOf(const StudyClaim& claim) {
  return {claim.says, claim.compared, claim.expected, claim.found, std::string(Text(claim.state))};
}

std::string ClaimsElement(const std::vector<StudyClaim>& claims) {
  if (claims.empty()) return "";
  std::string body;
  for (const StudyClaim& claim : claims) {
    std::string row = Row(CellsOf(claim), "th scope=\"row\"", "td");
    row.insert(std::string_view("<tr").size(),
               fmt::format(" class=\"claim-{}\"", Text(claim.state)));
    body += row;
  }
  const std::vector<std::string> columns(kClaimColumns.begin(), kClaimColumns.end());
  const std::string text = ClaimsText(claims);
  return Folded("claims", text,
                ScrollingTable(text, Row(columns, "th scope=\"col\"", "th scope=\"col\""), body));
}

std::string SectionElement(const StudySection& section) {
  std::string first;
  std::string figures;
  for (const StudyFigure& figure : section.figures) {
    (first.empty() ? first : figures) +=
        FigureElement(figure.id, EscapeHtml(figure.title), EscapeHtml(figure.caption),
                      EscapeHtml(figure.y_label) + ScaleText(figure));
  }
  std::string main_table;
  std::string tables;
  for (const StudyTable& table : section.tables) {
    if (main_table.empty()) {
      main_table = fmt::format("<p class=\"caption\">{}</p>\n{}", EscapeHtml(table.caption),
                               TableElement(table));
    } else {
      tables += Folded("values", table.caption, TableElement(table));
    }
  }
  if (!figures.empty()) {
    figures = Folded("more-figures", "More figures",
                     fmt::format("<div class=\"figures\">\n{}</div>\n", figures));
  }
  return fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n"
      "<p class=\"question\">{2}</p>\n<div class=\"finding\">\n<p>{3}</p>\n{4}</div>\n"
      "<div class=\"figures\">\n{5}</div>\n{6}<p class=\"note\"><b>What would change this "
      "answer?</b> {7}</p>\n{8}{9}{10}</section>\n",
      section.name, EscapeHtml(section.title), EscapeHtml(section.question),
      EscapeHtml(section.answer), ClaimsElement(section.claims), first, main_table,
      EscapeHtml(section.would_change), figures,
      Folded("method", "Method",
             fmt::format("<p class=\"note\">{}</p>\n", EscapeHtml(section.method))),
      tables);
}

/// A row of a Markdown table.
std::string TextRow(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells)
    row += fmt::format(" {} |", boost::replace_all_copy(cell, "|", "\\|"));
  return row + "\n";
}

std::string TextTable(const std::vector<std::string>& columns,
                      const std::vector<std::vector<std::string>>& rows, bool numbers) {
  std::string text = TextRow(columns) + "|";
  for (std::size_t i = 0; i < columns.size(); ++i) text += i > 0 && numbers ? "---:|" : "---|";
  text += "\n";
  for (const std::vector<std::string>& row : rows) text += TextRow(row);
  return text;
}

}  // namespace

std::string_view Text(ClaimState state) {
  switch (state) {
    case ClaimState::kHolds:
      return "holds";
    case ClaimState::kFails:
      return "fails";
    case ClaimState::kOpen:
      return "open";
  }
  return "";
}

std::string MakeStudyPage(const std::string& command, std::span<const StudySection> sections) {
  std::string content;
  std::string links;
  json figures = json::array();
  for (const StudySection& section : sections) {
    content += SectionElement(section);
    links +=
        fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.name, EscapeHtml(section.title));
    for (const StudyFigure& figure : section.figures) figures.push_back(FigureData(figure));
  }
  return Fill(
      assets::kStudyHtml,
      {{"style", fmt::format("{}\n{}\n{}", assets::kUplotCss, assets::kPageCss, assets::kStudyCss)},
       {"command", EscapeHtml(command)},
       {"links", links},
       {"sections", content},
       {"data", EscapeScript(figures.dump())},
       {"uplot", std::string(assets::kUplotJs)},
       {"uplot_license", EscapeHtml(assets::kUplotLicense)},
       {"uplot_version", std::string(assets::kUplotVersion)},
       {"script", fmt::format("{}\n{}", assets::kScrollJs, assets::kStudyJs)}});
}

std::string MakeStudyText(const std::string& command, std::span<const StudySection> sections) {
  std::string text = fmt::format(
      "# Studies\n\nMade by `{}`. The same command writes all rows as CSV, and a page with "
      "figures.\n",
      command);
  for (const StudySection& section : sections) {
    text += fmt::format("\n## {}\n\n*{}*\n\n{}\n\n**What would change this answer?** {}\n",
                        section.title, section.question, section.answer, section.would_change);
    if (!section.tables.empty()) {
      const StudyTable& table = section.tables.front();
      text += fmt::format("\n{}:\n\n{}", table.caption, TextTable(table.columns, table.rows, true));
    }
    if (!section.claims.empty()) {
      std::vector<std::vector<std::string>> rows;
      for (const StudyClaim& claim : section.claims) rows.push_back(CellsOf(claim));
      text += fmt::format("\n{}:\n\n{}", ClaimsText(section.claims),
                          TextTable({kClaimColumns.begin(), kClaimColumns.end()}, rows, false));
    }
    text +=
        fmt::format("\n<details><summary>Method</summary>\n\n{}\n\n</details>\n", section.method);
  }
  return text;
}

}  // namespace fogline::report
