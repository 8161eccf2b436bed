#include "tools/benchmarks/growth.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "tools/benchmarks/program.h"

namespace fogline::benchmarks {
namespace {

constexpr double kMicrosPerSecond = 1e6;

/// Time and memory of the work of one size.
struct Cost {
  double wall_s;
  double memory_mb;
};

/// Measures how the cost of some work grows with its size, such as the number of following cars.
/// `work` does the work of one size. `pieces` returns the number of equal pieces of this work, such
/// as the steps of the run.
struct Trial {
  Growth growth;
  std::vector<std::int64_t> sizes;
  std::function<double(std::int64_t size)> pieces;
  std::function<Cost(std::int64_t size)> work;
};

/// Makes a run in one process. `wall_s` is the time that the run itself reports, so it does not
/// include the start of the program.
Cost Run(std::int64_t followers, std::int64_t steps) {
  const ProgramResult result =
      RunProgram({ProgramPath("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                  "--json", "--quiet", "--set", fmt::format("/followers/count={}", followers),
                  "--set", fmt::format("/steps={}", steps)});
  return {.wall_s = nlohmann::json::parse(result.out)["wall_s"],
          .memory_mb = result.peak_memory_mb};
}

Cost Sweep(std::int64_t runs) {
  const std::filesystem::path rows = ScratchFolder() / fmt::format("growth-{}.csv", runs);
  const ProgramResult result =
      RunProgram({ProgramPath("fogline"), "sweep", "scenario/paper.json", "--seeds",
                  fmt::format("1:{}", runs), "--jobs", "1", "--force", "--json", "--out", rows});
  std::filesystem::remove(rows);
  return {.wall_s = nlohmann::json::parse(result.out)["wall_s"],
          .memory_mb = result.peak_memory_mb};
}

std::vector<Trial> Trials(Effort effort) {
  const bool full = effort == Effort::kFull;
  const std::int64_t steps = full ? 100'000 : 10'000;  // of each run in the trial `followers`
  std::vector<Trial> trials;
  trials.push_back(
      {.growth = {.name = "followers", .what = "following cars", .piece = "step", .points = {}},
       .sizes = {1, 2, 4, 8, 16, 32},
       .pieces = [steps](std::int64_t) { return static_cast<double>(steps); },
       .work = [steps](std::int64_t size) { return Run(size, steps); }});
  trials.push_back({.growth = {.name = "steps", .what = "steps", .piece = "step", .points = {}},
                    .sizes = {100, 1'000, 10'000, 100'000, 1'000'000},
                    .pieces = [](std::int64_t size) { return static_cast<double>(size); },
                    .work = [](std::int64_t size) { return Run(1, size); }});
  trials.push_back(
      {.growth = {.name = "runs", .what = "runs of a sweep", .piece = "run", .points = {}},
       .sizes = {10, 100, 1'000},
       .pieces = [](std::int64_t size) { return static_cast<double>(size); },
       .work = [](std::int64_t size) { return Sweep(size); }});
  if (full) {
    trials[1].sizes.push_back(10'000'000);
    trials[2].sizes.push_back(10'000);
  }
  return trials;
}

/// The value at `x` of the least-squares line through the points.
double LineAt(double x, std::span<const GrowthPoint> points) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const GrowthPoint& point : points) {
    const auto size = static_cast<double>(point.size);
    sx += size;
    sy += point.wall_s.median;
    sxx += size * size;
    sxy += size * point.wall_s.median;
  }
  const auto n = static_cast<double>(points.size());
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return (sy - slope * sx) / n + slope * x;
}

std::string GrowthCaption(const Occasion& occasion) {
  return fmt::format("Medians of {} rounds; one core; {}, {}.", occasion.rounds, occasion.cpu,
                     occasion.date);
}

}  // namespace

std::vector<Growth> MeasureGrowth(Effort effort, int rounds) {
  std::vector<Growth> all;
  for (Trial& trial : Trials(effort)) {
    std::vector<std::vector<double>> wall_s(trial.sizes.size());
    std::vector<std::vector<double>> memory_mb(trial.sizes.size());
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 0; i < trial.sizes.size(); ++i) {
        const Cost cost = trial.work(trial.sizes[i]);
        wall_s[i].push_back(cost.wall_s);
        memory_mb[i].push_back(cost.memory_mb);
      }
    }
    for (std::size_t i = 0; i < trial.sizes.size(); ++i) {
      const Spread took = SpreadOf(wall_s[i]);
      trial.growth.points.push_back(
          {.size = trial.sizes[i],
           .wall_s = took,
           .per_piece = took.median * kMicrosPerSecond / trial.pieces(trial.sizes[i]),
           .memory_mb = SpreadOf(memory_mb[i]).median});
    }
    const std::span<const GrowthPoint> points(trial.growth.points);
    const GrowthPoint& largest = points.back();
    trial.growth.beyond_linear = largest.wall_s.median / LineAt(static_cast<double>(largest.size),
                                                                points.first(points.size() - 1));
    all.push_back(std::move(trial.growth));
  }
  return all;
}

std::string GrowthText(const std::vector<Growth>& all, const Occasion& occasion) {
  std::string text = GrowthCaption(occasion) + "\n";
  for (const Growth& growth : all) {
    text += fmt::format("\n{:>16}{:>14}{:>16}{:>14}\n", growth.what, "time (s)",
                        "per " + growth.piece + " (us)", "memory (MB)");
    for (const GrowthPoint& point : growth.points) {
      text += fmt::format("{:>16}{:>14.4g}{:>16.4g}{:>14.1f}\n",
                          WithThousands(std::to_string(point.size)), point.wall_s.median,
                          point.per_piece, point.memory_mb);
    }
    text +=
        fmt::format("  the last time, compared with a straight line through the others: {:.2f}\n",
                    growth.beyond_linear);
  }
  return text;
}

std::string GrowthMarkdown(const std::vector<Growth>& all, const Occasion& occasion) {
  std::string text =
      "| what grows | | time | for each | peak memory | beside a straight line |\n"
      "|---|---|---|---|---|---|\n";
  for (const Growth& growth : all) {
    for (const GrowthPoint& point : growth.points) {
      const bool last = &point == &growth.points.back();
      text += fmt::format("| {} | {} | {:.3g} s | {}: {:.3g} us | {:.1f} MB | {} |\n", growth.what,
                          WithThousands(std::to_string(point.size)), point.wall_s.median,
                          growth.piece, point.per_piece, point.memory_mb,
                          last ? fmt::format("{:.2f}", growth.beyond_linear) : "");
    }
  }
  return text + "\n" + GrowthCaption(occasion) + "\n";
}

std::string GrowthJson(const std::vector<Growth>& all, const Occasion& occasion) {
  nlohmann::ordered_json json{{"cpu", occasion.cpu},
                              {"date", occasion.date},
                              {"rounds", occasion.rounds},
                              {"growth", nlohmann::ordered_json::array()}};
  for (const Growth& growth : all) {
    nlohmann::ordered_json row{{"name", growth.name},
                               {"piece", growth.piece},
                               {"beyond_linear", growth.beyond_linear},
                               {"points", nlohmann::ordered_json::array()}};
    for (const GrowthPoint& point : growth.points) {
      row["points"].push_back(
          {{"size", point.size},
           {"wall_s", point.wall_s.median},
           {"wall_quartiles_s", {point.wall_s.lower_quartile, point.wall_s.upper_quartile}},
           {"per_" + growth.piece + "_us", point.per_piece},
           {"memory_mb", point.memory_mb}});
    }
    json["growth"].push_back(std::move(row));
  }
  return json.dump(2) + "\n";
}

void DrawGrowth(const std::vector<Growth>& all, const std::filesystem::path& chart) {
  const std::filesystem::path script = ScratchFolder() / "growth.gnuplot";
  std::ofstream out(script);
  out << "set terminal svg size 1080,330 font 'sans-serif,14' background '#ffffff'\n"
      << "set output '" << chart.string() << "'\n"
      << "set multiplot layout 1," << all.size() << "\n"
      << "set grid\nset border 3\nset tics nomirror\n"
      << "set yrange [0:*]\nset key off\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    // Sizes that differ by decades need a logarithmic axis. Other sizes have a linear axis, on
    // which linear growth is a straight line.
    constexpr std::int64_t kDecades = 100;
    const bool wide = all[i].points.back().size >= kDecades * all[i].points.front().size;
    out << (wide ? "set logscale x\nset format x '10^{%L}'\n"
                 : "unset logscale x\nset format x '%g'\nset xrange [0:*]\n");
    if (wide) out << "set autoscale x\n";
    out << "$data" << i << " << EOD\n";
    for (const GrowthPoint& point : all[i].points) {
      out << point.size << " " << point.per_piece << "\n";
    }
    out << "EOD\nset xlabel '" << all[i].what << "'\nset ylabel 'us for each " << all[i].piece
        << "'\nplot $data" << i << " with linespoints lw 2 pt 7 ps 0.7 lc rgb '#0b6e99'\n";
  }
  out.close();
  RunProgram({"gnuplot", script});
}

}  // namespace fogline::benchmarks
