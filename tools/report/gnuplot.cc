#include "tools/report/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

extern char** environ;

namespace fogline {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

[[noreturn]] void Fail(const std::string& what, const std::string& why) {
  throw std::runtime_error(what + ": " + why);
}

/// A file without a name, which goes away by itself.
File NamelessFile() {
  File file(std::tmpfile());
  if (file == nullptr) Fail("temporary file", std::strerror(errno));
  return file;
}

/// What is in `file`, from its beginning, without white space at the ends.
std::string TextOf(std::FILE* file) {
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

/// Where a child's standard streams come from and go to.
class Streams {
 public:
  Streams() { posix_spawn_file_actions_init(&actions_); }
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  void Connect(int descriptor, std::FILE* file) {
    posix_spawn_file_actions_adddup2(&actions_, fileno(file), descriptor);
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// Exit status of gnuplot, in the form of waitpid(). The script is read as a file, not as if typed:
/// gnuplot then ends at the first error.
int StatusOfGnuplot(const Streams& streams) {
  std::string name = "gnuplot";
  std::string ignore_personal_settings = "-d";
  std::string script = "/dev/stdin";
  std::array<char*, 4> arguments{name.data(), ignore_personal_settings.data(), script.data(),
                                 nullptr};
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, name.c_str(), streams.get(), nullptr, arguments.data(), environ);
  if (error == ENOENT) Fail("gnuplot", "not found; it draws the PNG files (package gnuplot-nox)");
  if (error != 0) Fail("gnuplot", std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) Fail("gnuplot", std::strerror(errno));
  }
  return status;
}

}  // namespace

void RunGnuplot(const std::string& script, const std::filesystem::path& output) {
  const File input = NamelessFile();
  const File words = NamelessFile();
  File picture(std::fopen(output.c_str(), "wb"));
  if (picture == nullptr) Fail(output.string(), std::strerror(errno));
  std::fwrite(script.data(), 1, script.size(), input.get());
  if (std::fflush(input.get()) != 0) Fail("temporary file", std::strerror(errno));

  Streams streams;
  streams.Connect(STDIN_FILENO, input.get());
  streams.Connect(STDOUT_FILENO, picture.get());
  streams.Connect(STDERR_FILENO, words.get());
  try {
    if (StatusOfGnuplot(streams) != 0) Fail("gnuplot", TextOf(words.get()));
  } catch (...) {
    picture.reset();
    std::error_code ignored;
    std::filesystem::remove(output, ignored);
    throw;
  }
}

std::string PngTerminal(std::size_t height_px) {
  return fmt::format(
      "set encoding utf8\nset minussign\n"
      "set terminal pngcairo noenhanced size 1600,{} font 'sans,20' linewidth 2 "
      "background rgb 'white'\n",
      height_px);
}

const std::string_view kPngAxes =
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

}  // namespace fogline
