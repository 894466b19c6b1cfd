// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#ifdef __x86_64__
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace inr {

/// Tells whether floating-point arithmetic of this thread overflowed, by the flag that the
/// processor keeps anyway. A number can become infinite, and from there NaN, only by way of it. The
/// modes (rounding, flushing to zero, traps) stay as the caller set them, and the flags are put
/// back.
class OverflowWatch
{
public:
#ifdef __x86_64__
  OverflowWatch() : Before(_mm_getcsr()) { this->restart(); }
  ~OverflowWatch()
  {
    if (_mm_getcsr() != this->Before) {
      _mm_setcsr(this->Before);
    }
  }

  /// Forgets what has been seen.
  void restart()
  {
    if (this->overflowed()) {
      _mm_setcsr(_mm_getcsr() & ~static_cast<unsigned>(_MM_EXCEPT_OVERFLOW));
    }
  }

  bool overflowed() const { return (_mm_getcsr() & _MM_EXCEPT_OVERFLOW) != 0; }
#else
  OverflowWatch()
  {
    std::fegetexceptflag(&this->Before, FE_ALL_EXCEPT);
    this->restart();
  }
  ~OverflowWatch() { std::fesetexceptflag(&this->Before, FE_ALL_EXCEPT); }

  void restart() { std::feclearexcept(FE_OVERFLOW); }
  bool overflowed() const { return std::fetestexcept(FE_OVERFLOW) != 0; }
#endif
  OverflowWatch(const OverflowWatch&) = delete;
  OverflowWatch& operator=(const OverflowWatch&) = delete;

private:
#ifdef __x86_64__
  unsigned Before;
#else
  std::fexcept_t Before;
#endif
};

} // namespace inr
