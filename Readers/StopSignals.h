// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// While one exists, SIGINT and SIGTERM ask a long computation to stop instead of ending the
/// process. The destructor restores the handlers that were there and delivers what came meanwhile,
/// so that Python raises its KeyboardInterrupt and a batch job ends. A second signal ends the
/// process at once. One at a time.
class StopSignals
{
public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether one of the signals has come.
  bool Received() const;

private:
  struct Handlers;
  Handlers* Previous;
};
