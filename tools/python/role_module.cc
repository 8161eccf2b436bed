// The Python module fogline_lab._runtime: lets a class in Python take part in a run as a role. The
// process runs the same code as the process of every other role
// (services/runtime/process/service.h). Only PythonRole calls Python. This module contains no
// role's name: kGraph says which messages a role reads and writes. Python gets and returns the
// bytes of messages. fogline_lab.messages decodes and encodes them.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "scenario/io/loader.h"
#include "services/algorithm.h"
#include "services/runtime/process/service.h"

namespace fogline::python {
namespace {

namespace py = pybind11;

// ---- the messages of a role -----------------------------------------------------------------

/// The message types of all channels that `Has` accepts, as a tuple type, in the order of kGraph.
template <class Has, std::size_t... I>
auto MessagesWhere(std::index_sequence<I...>) {
  const auto one = []<std::size_t i> {
    using M = typename std::tuple_element_t<i, decltype(kGraph)>::Message;
    if constexpr (Has()(kChannels[i])) {
      return std::tuple<M>();
    } else {
      return std::tuple<>();
    }
  };
  return std::tuple_cat(one.template operator()<I>()...);
}
template <class Has>
using Messages = decltype(MessagesWhere<Has>(std::make_index_sequence<kNumChannels>{}));

template <Role role>
struct IsRead {
  constexpr bool operator()(const ChannelInfo& channel) const {
    return channel.pace == Pace::kStep && channel.to.Has(role);
  }
};
template <Role role>
struct IsWritten {
  constexpr bool operator()(const ChannelInfo& channel) const {
    return channel.pace == Pace::kStep && channel.from == role;
  }
};
template <Role role>
struct IsReadOnDemand {
  constexpr bool operator()(const ChannelInfo& channel) const {
    return channel.on_demand.Has(role);
  }
};

struct NoMessage {};
/// The only type of a tuple; NoMessage if the tuple is empty.
template <class Tuple>
struct Only {
  using Type = NoMessage;
};
template <class M>
struct Only<std::tuple<M>> {
  using Type = M;
};

// ---- calls of Python ------------------------------------------------------------------------

/// The object that makes the instance of the role (fogline_lab/role.py, _Factory). It is set while
/// Serve() runs.
py::object* factory = nullptr;

/// Calls Python. An exception in Python becomes a C++ exception with the same text.
/// @throws std::runtime_error
template <class Call>
auto Guarded(Call&& call) {
  const py::gil_scoped_acquire lock;
  try {
    return call();
  } catch (const py::error_already_set& error) {
    throw std::runtime_error(py::str(error.value()).cast<std::string>());
  } catch (const py::cast_error& error) {
    throw std::runtime_error(error.what());
  }
}

template <class M>
py::bytes Encoded(const M& message) {
  static std::vector<std::uint8_t> buffer;  // only one thread computes steps
  runtime::Encode(message, buffer);
  return py::bytes(reinterpret_cast<const char*>(buffer.data()), buffer.size());
}

template <class M>
void DecodeInto(M& message, const py::handle& bytes) {
  const auto view = bytes.cast<std::string_view>();
  const runtime::Bytes payload(reinterpret_cast<const std::uint8_t*>(view.data()), view.size());
  if (payload.size() < runtime::kHeaderEnd || runtime::ReadInt64(payload, 0) != M::getHash() ||
      !runtime::Decode(payload, message)) {
    throw std::runtime_error(fmt::format("the bytes are no {}", M::getTypeName()));
  }
}

// ---- the role -------------------------------------------------------------------------------

template <Role role, class Inputs = Messages<IsRead<role>>,
          class Outputs = Messages<IsWritten<role>>>
class PythonRole;

/// A role whose class is written in Python: an algorithm in the sense of services/algorithm.h.
template <Role role, class... In, class... Out>
class PythonRole<role, std::tuple<In...>, std::tuple<Out...>> {
 public:
  using Outputs = std::tuple<Out...>;
  using Output = std::conditional_t<sizeof...(Out) == 1, std::tuple_element_t<0, Outputs>, Outputs>;
  using OnDemand = typename Only<Messages<IsReadOnDemand<role>>>::Type;
  static constexpr bool kBegins = role == kRoles.front().role;
  static constexpr bool kReadsOnDemand = !std::is_same_v<OnDemand, NoMessage>;
  static constexpr bool kIsDriven = ChannelOf<driver_input_t>().to.Has(role);

  /// @throws std::runtime_error if Python raises an exception; the other functions do so, too
  explicit PythonRole(const Scenario& scenario)
      : instance_(Guarded([&] { return factory->attr("make")(PrintScenario(scenario)); })) {}
  ~PythonRole() {
    const py::gil_scoped_acquire lock;
    instance_.release().dec_ref();
  }
  PythonRole(const PythonRole&) = delete;
  PythonRole& operator=(const PythonRole&) = delete;

  const Output& Start(std::int64_t run_id) requires(kBegins) {
    return Take([&] { return instance_.attr("start")(run_id); });
  }

  const Output& Step(const In&... in) {
    return Take([&] { return instance_.attr("step")(Encoded(in)...); });
  }

  static bool UsesOnDemandInput(const Scenario& scenario) requires(kReadsOnDemand) {
    return Answer("uses_on_demand", scenario);
  }
  void SetOnDemandInput(const OnDemand& message) requires(kReadsOnDemand) {
    Guarded([&] { instance_.attr("on_demand")(Encoded(message)); });
  }

  static bool UsesLiveInput(const Scenario& scenario) requires(kIsDriven) {
    return Answer("uses_live", scenario);
  }
  void SetLiveInput(const driver_input_t* input) requires(kIsDriven) {
    Guarded([&] {
      instance_.attr("live")(input != nullptr ? py::object(Encoded(*input)) : py::none());
    });
  }

 private:
  static bool Answer(const char* question, const Scenario& scenario) {
    return Guarded(
        [&] { return factory->attr(question)(PrintScenario(scenario)).template cast<bool>(); });
  }

  /// Calls Python, and decodes the messages that the call returns as a tuple of bytes.
  template <class Call>
  const Output& Take(Call&& call) {
    Guarded([&] {
      const py::tuple results = call();
      [&]<std::size_t... I>(std::index_sequence<I...>) {
        (DecodeInto(OutputAt<I>(), results[I]), ...);
      }
      (std::index_sequence_for<Out...>{});
    });
    return output_;
  }

  template <std::size_t I>
  auto& OutputAt() {
    if constexpr (sizeof...(Out) == 1) {
      return output_;
    } else {
      return std::get<I>(output_);
    }
  }

  py::object instance_;
  Output output_{};
};

/// Whether a role computes steps. (The recorder does not.)
template <Role role>
constexpr bool kComputes = std::tuple_size_v<Messages<IsRead<role>>> != 0 &&
                           std::tuple_size_v<Messages<IsWritten<role>>> != 0;

/// Takes part in a run as the role with this name. @return the exit code (service.h)
int Serve(const std::string& name, py::object made_by, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "fogline-" + name);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  int code = -1;
  factory = &made_by;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto serve = [&]<std::size_t i> {
      constexpr Role role = kRoles[i].role;
      if constexpr (kComputes<role>) {
        if (name != kRoles[i].name) return;
        const py::gil_scoped_release unlock;
        code =
            runtime::RunService<PythonRole<role>>(static_cast<int>(arguments.size()), argv.data());
      }
    };
    (serve.template operator()<I>(), ...);
  }
  (std::make_index_sequence<kRoles.size()>{});
  factory = nullptr;
  if (code < 0) throw std::invalid_argument("no role computes steps by the name " + name);
  return code;
}

}  // namespace
}  // namespace fogline::python

PYBIND11_MODULE(_runtime, module) {
  module.def("serve", &fogline::python::Serve, pybind11::arg("role"), pybind11::arg("factory"),
             pybind11::arg("arguments"));
}
