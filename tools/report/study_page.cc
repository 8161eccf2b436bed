#include "tools/report/study_page.h"

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

// The drawings of the page need no more digits. With rounding, equal numbers give equal pages.
constexpr int kDigits = 6;

json Numbers(const std::vector<double>& values) {
  json numbers = json::array();
  for (const double value : values) {
    // Goes through text, for the shortest double that prints with these digits.
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

/// Notes on the y axis for the reader.
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

std::string TableElement(const StudyTable& table) {
  std::string body;
  for (const std::vector<std::string>& row : table.rows) body += Row(row, "th scope=\"row\"", "td");
  return fmt::format(
      "<details class=\"values\"><summary>{0}</summary>\n<div class=\"scroll\" role=\"region\" "
      "tabindex=\"0\" aria-label=\"{0}\"><table><thead>{1}</thead><tbody>\n{2}</tbody></table>"
      "</div></details>\n",
      EscapeHtml(table.caption), Row(table.columns, "th scope=\"col\"", "th scope=\"col\""), body);
}

std::string SectionElement(const StudySection& section) {
  std::string findings;
  for (const std::string& finding : section.findings) {
    findings += fmt::format("<p>{}</p>\n", EscapeHtml(finding));
  }
  std::string figures;
  for (const StudyFigure& figure : section.figures) {
    figures += FigureElement(figure.id, EscapeHtml(figure.title), EscapeHtml(figure.caption),
                             EscapeHtml(figure.y_label) + ScaleText(figure));
  }
  std::string tables;
  for (const StudyTable& table : section.tables) tables += TableElement(table);
  return fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n"
      "<p class=\"question\">{2}</p>\n<div class=\"finding\">\n{3}</div>\n"
      "<p class=\"note\">{4}</p>\n<div class=\"figures\">\n{5}</div>\n{6}</section>\n",
      section.name, EscapeHtml(section.title), EscapeHtml(section.question), findings,
      EscapeHtml(section.method), figures, tables);
}

/// A row of a Markdown table.
std::string TextRow(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells)
    row += fmt::format(" {} |", boost::replace_all_copy(cell, "|", "\\|"));
  return row + "\n";
}

}  // namespace

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
  std::string text = fmt::format("# Studies\n\nMade by `{}`.\n", command);
  for (const StudySection& section : sections) {
    text += fmt::format("\n## {}\n\n*{}*\n", section.title, section.question);
    for (const std::string& finding : section.findings) text += fmt::format("\n{}\n", finding);
    text += fmt::format("\n{}\n", section.method);
    for (const StudyTable& table : section.tables) {
      text += fmt::format("\n{}:\n\n{}|", table.caption, TextRow(table.columns));
      for (std::size_t i = 0; i < table.columns.size(); ++i) text += i == 0 ? "---|" : "---:|";
      text += "\n";
      for (const std::vector<std::string>& row : table.rows) text += TextRow(row);
    }
  }
  return text;
}

}  // namespace fogline::report
