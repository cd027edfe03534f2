// working.hpp: a simulation at work for Python.
//
// While it works the GIL is free, so other threads of Python run; every 50 ms it takes the GIL to check for Ctrl-C, and less often to report its
// progress.  One call uses it at a time: a second one, from another thread or from its own callback, is an error and does not wait, since a
// callback would wait for ever.
#pragma once
#include <toile/simulation.hpp>

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <string>
#include <utility>

namespace toile::python {

namespace nb = nanobind;

// A person does not notice 50 ms, and taking the GIL costs a microsecond, or 5 ms beside a thread that computes in Python.
constexpr std::chrono::milliseconds listening_interval{50};
constexpr std::chrono::milliseconds telling_interval{100};

// Polls for cancellation and reports progress during a call.  It does not affect the result, only whether the call goes on.
class Listener {
 public:
  void begin(nb::object progress) {
    progress_ = std::move(progress);
    raised_ = nullptr;
    cancelled_ = false;
    listened_ = told_ = {};
    phase_.clear();
    working_ = true;
  }
  // Needs the GIL.  Throws the exception that a signal or the callback has raised.
  void end() {
    working_ = false;
    progress_ = nb::object();
    if (std::exception_ptr raised = std::exchange(raised_, nullptr)) std::rethrow_exception(raised);
  }
  void abandon() noexcept {
    working_ = false;
    progress_ = nb::object();
    raised_ = nullptr;
  }
  void cancel() { cancelled_ = true; }
  bool working() const { return working_; }

  bool stop() {
    if (!working_) return false;  // under construction
    if (cancelled_) return true;
    if (!due(listened_, listening_interval)) return false;
    const nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) fail();  // signals reach the main thread only
    return cancelled_;
  }
  void tell(const Progress& progress) {
    if (!working_ || cancelled_ || !progress_.is_valid() || progress_.is_none()) return;
    const bool news = phase_ != progress.phase || progress.share >= 1;
    if (!news && !due(told_, telling_interval)) return;
    phase_ = progress.phase;
    const nb::gil_scoped_acquire gil;
    try {
      const nb::object left = progress.seconds_left < 0 ? nb::none() : nb::object(nb::float_(progress.seconds_left));
      progress_(nb::str(progress.phase.data(), progress.phase.size()), progress.share, left);
    } catch (const nb::python_error&) {
      raised_ = std::current_exception();
      cancelled_ = true;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static bool due(Clock::time_point& last, std::chrono::milliseconds interval) {
    const Clock::time_point now = Clock::now();
    if (now - last < interval) return false;
    last = now;
    return true;
  }
  void fail() {
    raised_ = std::make_exception_ptr(nb::python_error());
    cancelled_ = true;
  }

  nb::object progress_;
  std::exception_ptr raised_;
  std::atomic<bool> cancelled_ = false, working_ = false;
  Clock::time_point listened_, told_;
  std::string phase_;
};

// Makes a long call without the GIL.
template <class Call>
auto listened(Listener& listener, nb::object progress, const Call& call) {
  listener.begin(std::move(progress));
  try {
    auto result = [&] {
      const nb::gil_scoped_release others_may_run;
      return call();
    }();
    listener.end();
    return result;
  } catch (...) {
    listener.abandon();
    throw;
  }
}

class Working {
 public:
  template <class Make>
  explicit Working(Make make) : listener_(std::make_unique<Listener>()), simulation_(make(hooks())) {}

  // Makes a call that is long or changes the simulation.
  template <class Call>
  auto work(Call call, nb::object progress = nb::none()) {
    idle();
    return listened(*listener_, std::move(progress), [&] { return call(simulation_); });
  }
  const Simulation& look() const {
    idle();
    return simulation_;
  }
  Simulation& touch() {
    idle();
    return simulation_;
  }
  void cancel() { listener_->cancel(); }

 private:
  SimulationOptions hooks() {
    SimulationOptions options;
    options.cancelled = [listener = listener_.get()] { return listener->stop(); };
    options.progress = [listener = listener_.get()](const Progress& progress) { listener->tell(progress); };
    return options;
  }
  void idle() const {
    if (listener_->working())
      throw Error(ErrorCode::usage,
                  "the simulation is at work, in another thread or in the call that this callback belongs to; "
                  "use it when that call is over");
  }

  std::unique_ptr<Listener> listener_;  // at a fixed address, for the hooks
  Simulation simulation_;
};

}  // namespace toile::python
