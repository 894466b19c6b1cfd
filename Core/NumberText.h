// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iomanip>
#include <locale>
#include <sstream>
#include <string>

namespace inr {

/// A number for people, to so many significant digits, with a decimal point whatever the locale.
inline std::string NumberText(double value, int digits = 6)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(digits) << value;
  return text.str();
}

/// The same, to so many digits behind the point.
inline std::string DecimalText(double value, int digits)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

} // namespace inr
