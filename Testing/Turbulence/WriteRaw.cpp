// SPDX-License-Identifier: BSD-3-Clause
//
// Streams a turbulent channel of any size as raw voxels, to a file that ParaView opens or to a
// pipe.
#include "Core/Error.h"
#include "Testing/Turbulence/ChannelOptions.h"
#include "Testing/Turbulence/RawOutput.h"

namespace {

constexpr const char* Usage =
    "usage: turbulent_channel NX NY NZ OUTPUT [--type float32] [--endian little]\n"
    "                         [--seed 1] [--octaves 6] [--intensity 0.06] [--time 0]\n"
    "OUTPUT is a name ending in .mhd (MetaImage), whose voxels go into a .raw beside it, or - for\n"
    "the voxels on standard output. Types: float32, float64. Byte orders: little, big.\n";

[[noreturn]] void Refuse(const std::string& message)
{
  throw inr::Error(inr::ErrorCode::InvalidArgument, message);
}

// One of two words.
bool IsSecond(const std::string& text, const std::string& first, const std::string& second)
{
  if (text != first && text != second) {
    Refuse("'" + text + "' is neither " + first + " nor " + second);
  }
  return text == second;
}

inr::RawVolumeFile FileFrom(const inr::Options& options)
{
  constexpr std::int64_t mostVoxels = std::int64_t{1} << 59; // their bytes fit 63 bits
  inr::RawVolumeFile file;
  std::int64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("N") + "XYZ"[axis];
    const std::int64_t size =
        inr::ParseInteger(options.positional()[static_cast<std::size_t>(axis)], name);
    if (size < 1) {
      Refuse(name + ": " + std::to_string(size) + " is no size");
    }
    if (size > mostVoxels / voxels) {
      Refuse("NX NY NZ: more than " + std::to_string(mostVoxels) + " voxels");
    }
    file.dims[axis] = size;
    voxels *= size;
  }
  file.doubles = IsSecond(options.text("--type", "float32"), "float32", "float64");
  file.bigEndian = IsSecond(options.text("--endian", "little"), "little", "big");
  return file;
}

void Write(const inr::Options& options)
{
  if (options.positional().size() != 4) {
    Refuse("name three sizes and an output");
  }
  const inr::TurbulentChannel field(inr::FieldFrom(options));
  const inr::RawVolumeFile file = FileFrom(options);
  const std::string output = options.positional()[3];
  if (output == "-") {
    inr::StreamRawVolume(field, file);
    return;
  }
  const std::string ending = ".mhd";
  if (output.size() <= ending.size() ||
      output.compare(output.size() - ending.size(), ending.size(), ending) != 0) {
    Refuse("'" + output + "' does not end in .mhd");
  }
  inr::WriteRawVolume(field, file, output.substr(0, output.size() - ending.size()));
}

} // namespace

int main(int argc, char** argv)
{
  return inr::RunProgram(argc, argv, Usage, {"--type", "--endian"}, Write);
}
