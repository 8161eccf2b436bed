#include "tools/report/plots/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "common/file.h"
#include "common/interrupt.h"

extern char** environ;

namespace fogline::report {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

[[noreturn]] void Fail(const std::string& what, const std::string& why) {
  throw std::runtime_error(what + ": " + why);
}

/// A temporary file without a name. The system deletes the file when the file is closed.
File NamelessFile() {
  File file(std::tmpfile());
  if (file == nullptr) Fail("temporary file", std::strerror(errno));
  return file;
}

/// The whole content of `file`, without white space at its ends.
std::string ContentOf(std::FILE* file) {
  std::string text;
  std::array<char, 4096> part{};
  std::rewind(file);
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), file)) {
    text.append(part.data(), size);
  }
  constexpr const char* kSpace = " \n\r\t";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(kSpace) + 1 - begin);
}

/// Standard streams of a child process.
class Streams {
 public:
  Streams() { posix_spawn_file_actions_init(&actions_); }
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  void Connect(int descriptor, int to) {
    posix_spawn_file_actions_adddup2(&actions_, to, descriptor);
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// A running gnuplot. gnuplot reads the script as a file and not as typed input. So gnuplot ends at
/// the first error. gnuplot does not report a failed write. On a full disk it would write a part of
/// the picture, and end without an error. So gnuplot writes into a pipe, and this program writes
/// the file.
class Gnuplot {
 public:
  /// Starts gnuplot.
  /// @param script the file from which gnuplot reads its standard input
  /// @param words the file into which gnuplot writes its standard error
  Gnuplot(std::FILE* script, std::FILE* words) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) Fail("gnuplot", std::strerror(errno));
    out_ = ends[0];
    Streams streams;
    streams.Connect(STDIN_FILENO, fileno(script));
    streams.Connect(STDOUT_FILENO, ends[1]);
    streams.Connect(STDERR_FILENO, fileno(words));
    const int error = Start(streams);
    close(ends[1]);
    if (error == 0) return;
    close(out_);
    if (error == ENOENT)
      Fail("gnuplot", "not found; it draws the files of figures (package gnuplot-nox)");
    Fail("gnuplot", std::strerror(error));
  }
  /// Closes the pipe, and waits until gnuplot ends. gnuplot ends at its next write into the closed
  /// pipe.
  ~Gnuplot() { Wait(); }
  Gnuplot(const Gnuplot&) = delete;
  Gnuplot& operator=(const Gnuplot&) = delete;

  /// The next bytes of standard output; "" at its end.
  std::string_view Read() {
    ssize_t size = 0;
    do {
      size = read(out_, buffer_.data(), buffer_.size());
    } while (size < 0 && errno == EINTR);
    if (size < 0) Fail("gnuplot", std::strerror(errno));
    return {buffer_.data(), static_cast<std::size_t>(size)};
  }

  /// Closes the pipe, and waits until gnuplot ends. @return the exit status, in the form of
  /// waitpid()
  int Wait() {
    if (out_ < 0) return status_;
    close(std::exchange(out_, -1));
    while (waitpid(child_, &status_, 0) < 0 && errno == EINTR) {
    }
    return status_;
  }

 private:
  /// @return 0, or the error number if gnuplot cannot be started
  int Start(const Streams& streams) {
    std::string name = "gnuplot";
    std::string ignore_personal_settings = "-d";
    std::string script = "/dev/stdin";
    std::array<char*, 4> arguments{name.data(), ignore_personal_settings.data(), script.data(),
                                   nullptr};
    return posix_spawnp(&child_, name.c_str(), streams.get(), nullptr, arguments.data(), environ);
  }

  pid_t child_ = 0;
  int status_ = -1;
  int out_ = -1;
  std::array<char, kWorthACall> buffer_{};
};

/// Settings of gnuplot for a format. Relative to the picture, letters and lines have the same size
/// in all formats.
struct FormatRow {
  FigureFormat format;
  std::string_view suffix;
  std::string_view terminal;
  double unit;  // size in the terminal's unit for one unit of kWidth
  std::string_view font;
  double font_scale;
  double line_width;
  double point_scale;
};

constexpr double kInches = 1.0 / 200;  // makes a PDF figure 8 inches wide
constexpr std::array kFormats{
    FormatRow{FigureFormat::kPng, "png", "pngcairo", 1, "sans", 1, 2, 1},
    // A font size of 1 is 4/3 units of length in the cairo terminals, and 1 unit in svg. So the
    // font of svg is scaled by 4/3.
    FormatRow{FigureFormat::kSvg, "svg", "svg", 1, "sans-serif", 4.0 / 3, 2, 0.7},
    FormatRow{FigureFormat::kPdf, "pdf", "pdfcairo", kInches, "sans", 0.36, 1.44, 1},
};

const FormatRow& FormatRowOf(FigureFormat format) {
  return *std::ranges::find(kFormats, format, &FormatRow::format);
}

}  // namespace

void RunGnuplot(const std::string& script, AtomicFile& picture) {
  const File input = NamelessFile();
  const File words = NamelessFile();
  if (const int error = WriteAll(fileno(input.get()), script); error != 0) {
    Fail("temporary file", std::strerror(error));
  }
  if (lseek(fileno(input.get()), 0, SEEK_SET) != 0) Fail("temporary file", std::strerror(errno));
  Gnuplot gnuplot(input.get(), words.get());
  for (std::string_view part = gnuplot.Read(); !part.empty(); part = gnuplot.Read()) {
    picture.Write(part);
  }
  const int status = gnuplot.Wait();
  // Ctrl-C also ends gnuplot. So the interrupt is checked before gnuplot's status.
  if (WasInterrupted()) throw Interrupted("interrupted; no file was written");
  if (status != 0) Fail("gnuplot", ContentOf(words.get()));
}

std::string FigureFile(FigureFormat format, std::string_view name) {
  return fmt::format("figure-{}.{}", name, FormatRowOf(format).suffix);
}

std::string Terminal(FigureFormat format, double height) {
  const FormatRow& row = FormatRowOf(format);
  return fmt::format(
      "set encoding utf8\nset minussign\n"
      "set terminal {} noenhanced size {},{} font '{},20' fontscale {} linewidth {} "
      "background rgb 'white'\npoint_scale = {}\n",
      row.terminal, kWidth * row.unit, height * row.unit, row.font, row.font_scale, row.line_width,
      row.point_scale);
}

std::string Margins(const Place& place) {
  return fmt::format(
      "set margins at screen {:.4f}, at screen {:.4f}, at screen {:.4f}, at screen {:.4f}\n",
      place.left, place.right, place.bottom, place.top);
}

std::string NameOfX(std::string_view name, double height) {
  constexpr double kBelowPlot = 88;  // distance to the middle of the letters
  return fmt::format("set label {} {} at graph 0.5, graph 0 center offset screen 0, {:.4f}\n",
                     kLabelOfX, GnuplotString(name), -kBelowPlot / height);
}

std::string NameOfY(std::string_view name, double middle) {
  constexpr double kFromLeft = 38;  // distance to the middle of the letters
  return fmt::format("set label {} {} at screen {:.4f}, screen {:.4f} center rotate\n", kLabelOfY,
                     GnuplotString(name), kFromLeft / kWidth, middle);
}

const std::string_view kAxes =
    "set border 3 linecolor rgb '#1b2127' linewidth 0.6\n"
    "set xtics nomirror out scale 0.5\nset ytics nomirror out scale 0.5\n"
    "set grid linecolor rgb '#e3e3de' linetype 1 linewidth 0.5\n";

std::string GnuplotString(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += '\'';
    const bool control = static_cast<unsigned char>(c) < 0x20;
    quoted += control ? ' ' : c;
  }
  return quoted + "'";
}

}  // namespace fogline::report
