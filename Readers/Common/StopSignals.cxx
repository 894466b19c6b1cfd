// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Common/StopSignals.h"

#include <atomic>
#include <csignal>
#include <new>

namespace {

// Lock-free, so that a signal handler may write it.
std::atomic<int> ReceivedSignal{0};
std::atomic<int> Depth{0}; ///< how many there are, one within the other

/// The second one ends the process: whatever is to look for the first does not come to it.
void Remember(int signal)
{
  if (ReceivedSignal.exchange(signal) != 0) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

} // namespace

struct StopSignals::Handlers
{
  struct sigaction Interrupt;
  struct sigaction Terminate;
};

StopSignals::StopSignals() : Previous(Depth++ == 0 ? new (std::nothrow) Handlers : nullptr)
{
  if (this->Previous == nullptr) {
    return; // within another, or a signal ends the process, as it does without this; no memory
            // will be said soon enough
  }
  struct sigaction action = {};
  action.sa_handler = Remember;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &this->Previous->Interrupt);
  sigaction(SIGTERM, &action, &this->Previous->Terminate);
}

StopSignals::~StopSignals()
{
  if (this->Previous != nullptr) {
    sigaction(SIGINT, &this->Previous->Interrupt, nullptr);
    sigaction(SIGTERM, &this->Previous->Terminate, nullptr);
    delete this->Previous;
  }
  const int signal = --Depth == 0 ? ReceivedSignal.exchange(0) : 0;
  if (signal != 0) {
    std::raise(signal);
  }
}

bool StopSignals::Received() { return ReceivedSignal != 0; }
