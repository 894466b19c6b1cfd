// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/GradientExchange.h"

#include "Core/Model/LittleEndian.h"
#include "Core/Training/TrainingClock.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>

namespace inr {

namespace {

/// Pieces of the grid that are sent together: 4 MiB of parameters at most.
constexpr std::size_t PiecesAtATime = 32;

std::int64_t LinesOf(const GridGradient::Piece& piece)
{
  return (piece.count + GradientLine - 1) / GradientLine;
}

std::int64_t LineSize(const GridGradient::Piece& piece, std::int64_t line)
{
  return std::min(GradientLine, piece.count - line * GradientLine);
}

/// A piece's part of a message: a byte for each line that says whether it is touched, then the
/// touched ones.
std::size_t PartSize(const GridGradient::Piece& piece)
{
  const std::int64_t lines = LinesOf(piece);
  std::int64_t floats = std::count(piece.touched, piece.touched + lines, 1) * GradientLine;
  if (piece.touched[lines - 1] != 0) { // of a level's end
    floats -= GradientLine - LineSize(piece, lines - 1);
  }
  return static_cast<std::size_t>(lines) + static_cast<std::size_t>(floats) * sizeof(float);
}

/// Of a whole line the compiler knows the size.
void CopyLine(void* to, const void* from, std::int64_t floats)
{
  if (floats == GradientLine) {
    std::memcpy(to, from, GradientLine * sizeof(float));
  } else {
    std::memcpy(to, from, static_cast<std::size_t>(floats) * sizeof(float));
  }
}

void WritePart(const GridGradient::Piece& piece, const float* values, char* part)
{
  const std::int64_t lines = LinesOf(piece);
  std::memcpy(part, piece.touched, static_cast<std::size_t>(lines));
  char* next = part + lines;
  for (std::int64_t line = 0; line < lines; ++line) {
    if (piece.touched[line] != 0) {
      const std::int64_t floats = LineSize(piece, line);
      CopyLine(next, values + line * GradientLine, floats);
      next += static_cast<std::size_t>(floats) * sizeof(float);
    }
  }
}

/// Where the next line of each process' part is, and its marks.
struct PartReader
{
  const char* marks;
  const char* next;
};

/// Adds a line of all processes that touched it; says whether any did.
bool AddLine(std::vector<PartReader>& parts, std::int64_t line, std::int64_t floats, float* sum)
{
  bool any = false;
  for (PartReader& part : parts) {
    if (part.marks[line] != 0) {
      float values[GradientLine] = {};
      CopyLine(values, part.next, floats);
      for (std::int64_t k = 0; k < GradientLine; ++k) {
        sum[k] += values[k];
      }
      part.next += static_cast<std::size_t>(floats) * sizeof(float);
      any = true;
    }
  }
  return any;
}

/// What this process had in the piece is among the parts.
void AddParts(const GridGradient::Piece& piece, float* values, std::vector<PartReader>& parts)
{
  const std::int64_t lines = LinesOf(piece);
  for (std::int64_t line = 0; line < lines; ++line) {
    const std::int64_t floats = LineSize(piece, line);
    float sum[GradientLine] = {};
    if (AddLine(parts, line, floats, sum)) {
      CopyLine(values + line * GradientLine, sum, floats);
      piece.touched[line] = 1;
    }
  }
}

std::string WeightsMessage(const std::optional<double>& loss, const float* weights,
                           std::size_t count)
{
  if (!loss) {
    return {};
  }
  std::string bytes(reinterpret_cast<const char*>(&*loss), sizeof(double));
  bytes.append(reinterpret_cast<const char*>(weights), count * sizeof(float));
  return bytes;
}

} // namespace

void GradientExchange::together(const std::function<void()>& work)
{
  TrainingClock clock;
  this->Group.together([&] {
    work();
    clock = TrainingClock();
  });
  this->Times.waiting += clock.seconds();
}

std::optional<double> GradientExchange::sum(const std::optional<double>& loss, float* weights,
                                            std::size_t count, GridGradient& grid)
{
  const TrainingClock clock;
  const std::vector<std::string> all = this->Group.gather(WeightsMessage(loss, weights, count));
  const auto stopped = [](const std::string& message) { return message.empty(); };
  if (std::any_of(all.begin(), all.end(), stopped)) {
    return std::nullopt;
  }
  double total = 0;
  std::fill_n(weights, count, 0.0f);
  for (const std::string& message : all) {
    total += FromBytes<double>(message.data());
    const char* const values = message.data() + sizeof(double);
    for (std::size_t k = 0; k < count; ++k) {
      weights[k] += FromBytes<float>(values + k * sizeof(float));
    }
  }
  const std::size_t pieces = grid.pieces().size();
  for (std::size_t begin = 0; begin < pieces; begin += PiecesAtATime) {
    this->sumPieces(grid, begin, std::min(begin + PiecesAtATime, pieces));
  }
  this->Times.exchanging += clock.seconds();
  return total;
}

void GradientExchange::sumPieces(GridGradient& grid, std::size_t begin, std::size_t end)
{
  this->pack(grid, begin, end);
  this->Group.gatherInto(this->Mine.data(), this->Begins.back(), this->All);
  this->addUp(grid, begin, end);
}

/// Where each part begins, then the parts.
void GradientExchange::pack(GridGradient& grid, std::size_t begin, std::size_t end)
{
  const std::size_t count = end - begin;
  const auto tasks = static_cast<std::int64_t>(count);
  this->Begins.assign(count + 1, count * sizeof(std::uint64_t));
  this->Threads.forEachBlock(tasks, 1, [&](std::int64_t k, std::int64_t) {
    const auto at = static_cast<std::size_t>(k);
    this->Begins[at + 1] = PartSize(grid.pieces()[begin + at]);
  });
  std::partial_sum(this->Begins.begin(), this->Begins.end(), this->Begins.begin());
  this->Mine.resize(std::max(this->Mine.size(), this->Begins.back()));
  this->Threads.forEachBlock(tasks, 1, [&](std::int64_t k, std::int64_t) {
    const auto at = static_cast<std::size_t>(k);
    const std::uint64_t first = this->Begins[at];
    std::memcpy(&this->Mine[at * sizeof(first)], &first, sizeof(first));
    const GridGradient::Piece& piece = grid.pieces()[begin + at];
    WritePart(piece, grid.values(piece), &this->Mine[first]);
  });
}

void GradientExchange::addUp(GridGradient& grid, std::size_t begin, std::size_t end) const
{
  const auto tasks = static_cast<std::int64_t>(end - begin);
  this->Threads.forEachBlock(tasks, 1, [&](std::int64_t k, std::int64_t) {
    const GridGradient::Piece& piece = grid.pieces()[begin + static_cast<std::size_t>(k)];
    std::vector<PartReader> parts;
    for (const std::size_t ofProcess : this->All.begins) {
      const char* const message = this->All.bytes.data() + ofProcess;
      const char* const part =
          message + FromBytes<std::uint64_t>(message + k * sizeof(std::uint64_t));
      parts.push_back({part, part + LinesOf(piece)});
    }
    AddParts(piece, grid.values(piece), parts);
  });
}

} // namespace inr
