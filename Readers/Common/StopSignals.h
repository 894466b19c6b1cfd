// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// While one exists, SIGINT and SIGTERM ask a long computation to stop instead of ending the
/// process. The destructor restores the handlers that were there and delivers what came meanwhile,
/// so that Python raises its KeyboardInterrupt and a batch job ends. A second signal ends the
/// process at once. Where one is made while another exists, as a filter's that a writer reads
/// through, both are asked to stop, and the outer one delivers.
class StopSignals
{
public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether one of the signals has come while one of these existed.
  static bool Received();

private:
  struct Handlers;
  Handlers* Previous;
};
