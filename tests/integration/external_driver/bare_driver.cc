// A human driver that uses only Fogline's message types. It shows the duties of a role in any
// language. (In C++ there is a shorter way: my_driver.cc.)
//
//   c++ -O2 -ffp-contract=off bare_driver.cc -I PREFIX/include -llcm -o bare_driver
//   ./bare_driver 'udpm://239.255.76.67:7700?ttl=0&recv_buf_size=2097152' &
//   fogline run scenario/paper.json --external driver --lcm-url 'udpm://239.255.76.67:7700?ttl=0'
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>

#include <lcm/lcm-cpp.hpp>

#include "fogline/driver_command_t.hpp"
#include "fogline/fingerprint.hpp"
#include "fogline/resend_t.hpp"
#include "fogline/run_t.hpp"
#include "fogline/status_t.hpp"
#include "fogline/truth_t.hpp"

using namespace fogline;

// Intelligent Driver Model (Treiber, Hennecke & Helbing, Physical Review E 62:1805, 2000), SI
// units.
double Idm(double v, double preceding_v, double gap, double time_gap) {
  constexpr double kMaxAcceleration = 0.73, kComfortable = 1.67, kMaxDeceleration = 9;
  constexpr double kStandstill = 2, kDesiredSpeed = 33.33, kExponent = 4;
  if (gap <= 0) return -kMaxDeceleration;
  const double dynamic_gap =
      v * time_gap + v * (v - preceding_v) / (2 * std::sqrt(kMaxAcceleration * kComfortable));
  const double gap_ratio = (kStandstill + std::max(0.0, dynamic_gap)) / gap;
  const double speed_term = std::pow(v / kDesiredSpeed, kExponent);
  return std::max(kMaxAcceleration * (1 - speed_term - gap_ratio * gap_ratio), -kMaxDeceleration);
}

class BareDriver {
 public:
  BareDriver(lcm::LCM& lcm, double time_gap) : lcm_(lcm), time_gap_(time_gap) {
    // 0 means no limit. By default LCM keeps 30 waiting messages and drops newer ones.
    lcm_.subscribe("RUN", &BareDriver::OnRun, this)->setQueueCapacity(0);
    lcm_.subscribe("TRUTH", &BareDriver::OnTruth, this)->setQueueCapacity(0);
    lcm_.subscribe("RESEND", &BareDriver::OnResend, this)->setQueueCapacity(0);
    char host[256] = "";
    gethostname(host, sizeof(host) - 1);
    status_.role = "driver";
    status_.host = host;
    status_.pid = getpid();
    status_.instance = getpid();  // a number that no other driver of this run has
    status_.type_fingerprint = TypeFingerprint();
    status_.header.step = -1;
  }

  bool stopped() const { return stopped_; }

  void SayStatus() {
    ++status_.sequence;
    if (status_.state != status_t::WAITING) lcm_.publish("STATUS", &status_);
  }

 private:
  // The driver joins the first run that waits for a driver. The runner repeats PREPARE until every
  // role has reported READY with the scenario's hash. Then the world starts.
  void OnRun(const lcm::ReceiveBuffer*, const std::string&, const run_t* run) {
    if (status_.state == status_t::WAITING && run->phase == run_t::PREPARE && IsFree(*run)) {
      status_.header.run_id = run->header.run_id;
      status_.scenario_hash = run->scenario_hash;
      status_.state = status_t::READY;
    }
    if (!IsOurs(run->header)) return;
    if (run->phase == run_t::PREPARE) SayStatus();
    stopped_ = run->phase == run_t::STOP || HasAnother(*run);
  }

  // RUN names each role that is started elsewhere, and the instance of the process that has this
  // role. The instance is 0 while the run waits for the role. If another process has this role, the
  // driver does not take part, because two processes of one role would contradict each other.
  bool IsFree(const run_t& run) const { return DriverOf(run) == 0; }
  bool HasAnother(const run_t& run) const {
    const int64_t driver = DriverOf(run);
    return driver != 0 && driver != status_.instance;
  }
  int64_t DriverOf(const run_t& run) const {
    for (int i = 0; i < run.num_external; ++i) {
      if (run.external[i] == status_.role) return run.holder[i];
    }
    return -1;  // the runner starts the driver itself
  }

  // Answers each step once. A TRUTH that comes twice gets no second answer.
  void OnTruth(const lcm::ReceiveBuffer*, const std::string&, const truth_t* truth) {
    const int64_t step = truth->header.step;
    if (!IsOurs(truth->header) || answers_.count(step) > 0) return;
    driver_command_t& answer = answers_[step];
    answer.header = truth->header;
    answer.acceleration_mps2 = Idm(std::max(truth->host_speed_mps, 0.0), truth->preceding_speed_mps,
                                   truth->host_gap_m, time_gap_);
    answer.readiness = 1;
    answer.input_sequence = -1;  // no person drives
    lcm_.publish("DRIVER_COMMAND", &answer);
    answers_.erase(answers_.begin(), answers_.lower_bound(step - 64));  // no role is so far behind
    status_.state = status_t::RUNNING;
    status_.header.step = step;
  }

  // Another role lacks an answer of this driver, so the driver repeats the answer. If the driver
  // lacks the TRUTH of that step, the driver asks for this TRUTH.
  void OnResend(const lcm::ReceiveBuffer*, const std::string&, const resend_t* resend) {
    if (!IsOurs(resend->header) || resend->channel != "DRIVER_COMMAND") return;
    const auto answer = answers_.find(resend->header.step);
    if (answer != answers_.end()) {
      lcm_.publish("DRIVER_COMMAND", &answer->second);
    } else {
      resend_t question = *resend;
      question.channel = "TRUTH";
      question.requester = status_.role;
      lcm_.publish("RESEND", &question);
    }
  }

  bool IsOurs(const header_t& header) const {
    return status_.state != status_t::WAITING && header.run_id == status_.header.run_id;
  }

  lcm::LCM& lcm_;
  const double time_gap_;
  status_t status_{};
  std::map<int64_t, driver_command_t> answers_;
  bool stopped_ = false;
};

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: bare_driver LCM_URL [TIME_GAP_S]\n";
    return 2;
  }
  lcm::LCM lcm(argv[1]);
  if (!lcm.good()) return 3;  // LCM has printed the reason
  BareDriver driver(lcm, argc > 2 ? std::atof(argv[2]) : 1.6);
  std::cout << "waiting for a run on " << argv[1] << std::endl;
  while (!driver.stopped()) {
    const int handled = lcm.handleTimeout(50);  // ms
    if (handled < 0) return 3;
    if (handled == 0) driver.SayStatus();  // a sign of life if no message came
  }
}
