#include "tools/study/detection/conflict_tables.h"

#include <algorithm>

#include <fmt/format.h>

namespace fogline::study {
namespace {

std::string BoundsText(const AlarmCount& alarms) {
  const auto [low, high] = alarms.ArlZeroBounds_s();
  return fmt::format("{} [{}, {}]", Text(alarms.ArlZero_s(), 0), Text(low, 0), Text(high, 0));
}

std::string InPercent(const Estimate& share) {
  Estimate percent = share;
  for (double* value : {&percent.mean, &percent.low, &percent.high}) *value *= kPercent;
  return Text(percent, 0);
}

std::string DelayText(const ConflictSet& set, std::size_t detector) {
  return set.IsCompared(detector) ? Text(set.DelayOf(detector), 2) : "no threshold";
}

std::vector<std::string> RowOfDetector(const ConflictSet& set, std::size_t d) {
  const DetectorThreshold& at = set.thresholds[d];
  const bool compared = set.IsCompared(d);
  std::vector<std::string> row{compared ? NamesOf(set, d) : Detectors()[d].name,
                               DelayText(set, d),
                               Text(set.Difference(d, 0), 2),
                               Text(set.auc[d], 3),
                               compared ? fmt::to_string(at.calibrated.alarms) : "–",
                               compared ? BoundsText(at.calibrated) : "–",
                               compared ? BoundsText(at.clear) : "–"};
  for (const ConflictOutcome& outcome : set.outcomes) {
    row.push_back(InPercent(outcome.detectors[d].detection));
  }
  return row;
}

std::string CellsOfThreshold(const DetectorThreshold& at) {
  std::string cells =
      fmt::format("{},{}", at.is_determined() ? "yes" : "no", CsvText(at.threshold));
  for (const AlarmCount* count : {&at.calibrated, &at.clear}) {
    const auto [low, high] = count->ArlZeroBounds_s();
    cells += fmt::format(",{},{},{},{}", count->alarms, CsvText(count->ArlZero_s()), CsvText(low),
                         CsvText(high));
  }
  return cells;
}

}  // namespace

std::string NameOfSet(const ConflictSet& set) {
  return fmt::format("{}, {} noise", set.fog, set.noise);
}

std::string NamesOf(const ConflictSet& set, std::size_t detector) {
  std::string names;
  for (std::size_t d = 0; d < Detectors().size(); ++d) {
    if (set.counts_as[d] != set.counts_as[detector]) continue;
    names += fmt::format("{}{}", names.empty() ? "" : "; ", Detectors()[d].name);
  }
  return names;
}

std::vector<std::size_t> Ranked(const ConflictSet& set) {
  std::vector<std::size_t> ranked;
  for (std::size_t d = 0; d < set.thresholds.size(); ++d) {
    if (set.IsCompared(d) && set.counts_as[d] == d) ranked.push_back(d);
  }
  if (!set.Ranks()) return ranked;
  std::ranges::stable_sort(ranked, {}, [&](std::size_t d) { return set.DelayOf(d).mean; });
  return ranked;
}

report::StudyTable TableOfParts(std::span<const ConflictSet> sets) {
  report::StudyTable table{
      .caption =
          "The parts of the Degree of Conflict: the delay from fog to alarm, and the change of the "
          "delay by each part. Means over the visibilities that rank detectors [95 % confidence "
          "intervals]",
      .columns = {"detector"}};
  for (const DocPart& part : kDocParts) table.rows.push_back({std::string(part.name)});
  for (const ConflictSet& set : sets) {
    if (!set.Ranks()) continue;
    table.columns.push_back(fmt::format("{}: delay (s)", NameOfSet(set)));
    table.columns.emplace_back("change (s)");
    for (std::size_t i = 0; i < kDocParts.size(); ++i) {
      const std::size_t d = DetectorNamed(kDocParts[i].detector);
      table.rows[i].push_back(DelayText(set, d));
      table.rows[i].push_back(
          i == 0 ? "–" : Text(set.Difference(d, DetectorNamed(kDocParts[i - 1].detector)), 2));
    }
  }
  return table;
}

report::StudyTable TableOfConditions(std::span<const ConflictSet> sets) {
  report::StudyTable table{.caption = "Which conditions rank detectors", .columns = {"condition"}};
  for (const double visibility_m : kVisibilities_m) {
    table.columns.push_back(fmt::format("{:g} m", visibility_m));
  }
  for (const ConflictSet& set : sets) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(NameOfSet(set));
    for (const ConflictOutcome& outcome : set.outcomes) row.emplace_back(Text(outcome.telling));
  }
  return table;
}

report::StudyTable TableOfOptions(const ConflictSet& set) {
  report::StudyTable table{
      .caption =
          fmt::format("Fog model {}: delay from fog to alarm (s) of each measure of a single "
                      "step, with and without the window and the known sign",
                      NameOfSet(set)),
      .columns = {"measure", "as it is", "with window", "with sign", "with window and sign"}};
  const std::vector<Detector>& all = Detectors();
  for (std::size_t d = ComparedMeasures().size(); d < all.size(); d += 3) {
    const std::size_t measure = all[d].measure;
    table.rows.push_back({all[measure].name, DelayText(set, measure), DelayText(set, d),
                          DelayText(set, d + 1), DelayText(set, d + 2)});
  }
  return table;
}

report::StudyTable TableOfDetectors(const ConflictSet& set) {
  report::StudyTable table{
      .caption =
          fmt::format("Fog model {}: {}", NameOfSet(set),
                      set.Ranks() ? "mean over the visibilities that rank detectors, soonest "
                                    "first; a row for each detector, with all its names"
                                  : "no visibility ranks detectors"),
      .columns = {"detector", "fog to alarm (s)", "difference from DoC (s)", "AUC",
                  "alarms behind its threshold", "ARL0 of these alarms (s)",
                  "ARL0 in other clear runs (s)"}};
  for (const ConflictOutcome& outcome : set.outcomes) {
    const double visibility_m = outcome.condition.visibility_m;
    table.columns.push_back(
        outcome.telling == Telling::kRanks
            ? fmt::format("detected at {:g} m (%)", visibility_m)
            : fmt::format("detected at {:g} m (%): {}", visibility_m, Text(outcome.telling)));
  }
  for (const std::size_t d : Ranked(set)) table.rows.push_back(RowOfDetector(set, d));
  for (std::size_t d = 0; d < set.thresholds.size(); ++d) {
    if (!set.IsCompared(d)) table.rows.push_back(RowOfDetector(set, d));
  }
  return table;
}

std::string ConflictCsv(std::span<const ConflictSet> sets) {
  std::string csv =
      "fog,visibility_m,noise,condition,measure,counts_as,n,has_threshold,threshold,"
      "calibration_alarms,calibrated_arl0_s,calibrated_arl0_ci95_low_s,calibrated_arl0_ci95_high_s,"
      "clear_alarms,arl0_s,arl0_ci95_low_s,arl0_ci95_high_s,detected,p_detected,p_ci95_low,"
      "p_ci95_high,delay_s,delay_ci95_low_s,delay_ci95_high_s,delay_if_detected_s,"
      "delay_minus_doc_s,delay_minus_doc_ci95_low_s,delay_minus_doc_ci95_high_s,auc,auc_ci95_low,"
      "auc_ci95_high,auc_minus_doc,auc_minus_doc_ci95_low,auc_minus_doc_ci95_high\n";
  for (const ConflictSet& set : sets) {
    for (const ConflictOutcome& outcome : set.outcomes) {
      for (std::size_t d = 0; d < outcome.detectors.size(); ++d) {
        const DetectorOutcome& one = outcome.detectors[d];
        const bool compared = set.IsCompared(d);
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", set.fog,
                           outcome.condition.visibility_m, set.noise, Text(outcome.telling),
                           Detectors()[d].name, Detectors()[set.counts_as[d]].name, set.seeds,
                           CellsOfThreshold(set.thresholds[d]),
                           compared ? fmt::to_string(one.detected) : "", CsvText(one.detection),
                           CsvText(one.delay_s), compared ? CsvText(one.delay_if_detected_s) : "");
        for (const Estimate& e : {one.delay_minus_doc_s, one.auc, one.auc_minus_doc}) {
          csv += fmt::format(",{}", CsvText(e));
        }
        csv += "\n";
      }
    }
  }
  return csv;
}

std::string RocCsv(std::span<const ConflictSet> sets) {
  std::string csv =
      "fog,visibility_m,noise,measure,false_positives,true_positives,ci95_low,"
      "ci95_high\n";
  for (const ConflictSet& set : sets) {
    if (set.noise != kUsualNoise) continue;
    for (const ConflictOutcome& outcome : set.outcomes) {
      for (std::size_t m = 0; m < ComparedMeasures().size(); ++m) {
        for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
          const Estimate& share = outcome.detectors[m].true_positives[i];
          csv += fmt::format("{},{},{},{},{:g},{}\n", set.fog, outcome.condition.visibility_m,
                             set.noise, Detectors()[m].name, kFalsePositives[i], CsvText(share));
        }
      }
    }
  }
  return csv;
}

}  // namespace fogline::study
