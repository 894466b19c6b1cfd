// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/GradientExchange.h"

#include "Core/Model/LittleEndian.h"
#include "Core/Training/TrainingClock.h"

#include <algorithm>
#include <cstring>

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

/// A byte that says so for each line, then the touched ones; they become zero, and untouched.
std::string TakeOut(const GridGradient::Piece& piece, float* values)
{
  const std::int64_t lines = LinesOf(piece);
  std::string bytes(reinterpret_cast<const char*>(piece.touched), static_cast<std::size_t>(lines));
  for (std::int64_t line = 0; line < lines; ++line) {
    if (piece.touched[line] != 0) {
      float* const first = values + line * GradientLine;
      const std::int64_t count = LineSize(piece, line);
      bytes.append(reinterpret_cast<const char*>(first),
                   static_cast<std::size_t>(count) * sizeof(float));
      std::fill_n(first, count, 0.0f);
      piece.touched[line] = 0;
    }
  }
  return bytes;
}

void Add(const GridGradient::Piece& piece, float* values, const char* bytes)
{
  const std::int64_t lines = LinesOf(piece);
  const char* next = bytes + lines;
  for (std::int64_t line = 0; line < lines; ++line) {
    if (bytes[line] == 0) {
      continue;
    }
    piece.touched[line] = 1;
    for (std::int64_t k = 0; k < LineSize(piece, line); ++k, next += sizeof(float)) {
      values[line * GradientLine + k] += FromBytes<float>(next);
    }
  }
}

/// Parts one after the other, with their sizes in front.
std::string Joined(const std::vector<std::string>& parts)
{
  std::string bytes;
  for (const std::string& part : parts) {
    const std::uint64_t size = part.size();
    bytes.append(reinterpret_cast<const char*>(&size), sizeof(size));
  }
  for (const std::string& part : parts) {
    bytes += part;
  }
  return bytes;
}

/// Where each of `count` joined parts begins.
std::vector<const char*> PartsOf(const std::string& bytes, std::size_t count)
{
  std::vector<const char*> parts;
  const char* next = bytes.data() + count * sizeof(std::uint64_t);
  for (std::size_t k = 0; k < count; ++k) {
    parts.push_back(next);
    next += FromBytes<std::uint64_t>(bytes.data() + k * sizeof(std::uint64_t));
  }
  return parts;
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

void GradientExchange::sumPieces(GridGradient& grid, std::size_t begin, std::size_t end) const
{
  const auto count = static_cast<std::int64_t>(end - begin);
  std::vector<std::string> mine(end - begin);
  this->Threads.forEachBlock(count, 1, [&](std::int64_t k, std::int64_t) {
    const GridGradient::Piece& piece = grid.pieces()[begin + static_cast<std::size_t>(k)];
    mine[static_cast<std::size_t>(k)] = TakeOut(piece, grid.values(piece));
  });
  const std::vector<std::string> all = this->Group.gather(Joined(mine));
  std::vector<std::vector<const char*>> parts;
  for (const std::string& message : all) {
    parts.push_back(PartsOf(message, end - begin));
  }
  this->Threads.forEachBlock(count, 1, [&](std::int64_t k, std::int64_t) {
    const GridGradient::Piece& piece = grid.pieces()[begin + static_cast<std::size_t>(k)];
    for (const std::vector<const char*>& ofRank : parts) {
      Add(piece, grid.values(piece), ofRank[static_cast<std::size_t>(k)]);
    }
  });
}

} // namespace inr
