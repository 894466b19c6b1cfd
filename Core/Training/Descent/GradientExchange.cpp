// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Descent/GradientExchange.h"

#include "Core/Model/LittleEndian.h"
#include "Core/Timer.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>

namespace inr {

namespace {

/// Pieces of the grid that are summed together, 4 MiB of parameters, unless there are more
/// processes.
std::size_t PiecesAtATime(std::size_t pieces, int processes)
{
  constexpr std::size_t fewest = 32;
  return std::min(pieces, std::max(fewest, static_cast<std::size_t>(processes)));
}

/// Where each part begins, and a byte for each line, come with the values.
constexpr std::size_t MostOfPiece =
    sizeof(std::uint64_t) + static_cast<std::size_t>(GridGradient::PieceSize) * sizeof(float) +
    static_cast<std::size_t>(GridGradient::PieceSize / GradientLine);

std::size_t MostSent(std::size_t pieces, int processes)
{
  return PiecesAtATime(pieces, processes) * MostOfPiece;
}

/// Either one's share from all, or all shares: the first is more where shares are not equal.
std::size_t MostReceived(std::size_t pieces, int processes)
{
  const auto size = static_cast<std::size_t>(processes);
  const std::size_t share = (PiecesAtATime(pieces, processes) + size - 1) / size;
  return size * share * MostOfPiece;
}

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

std::int64_t ExchangeBytes(const Layout& shape, int processes)
{
  std::size_t pieces = 0;
  const int features = shape.encodedWidth / std::max(1, static_cast<int>(shape.levels.size()));
  for (const GridLevel& level : shape.levels) {
    const std::int64_t count = std::int64_t{level.entries} * features;
    pieces +=
        static_cast<std::size_t>((count + GridGradient::PieceSize - 1) / GridGradient::PieceSize);
  }
  const std::size_t weights = sizeof(double) + shape.gridOffset * sizeof(float);
  const std::size_t gathered = (2 * static_cast<std::size_t>(processes) + 1) * weights;
  return static_cast<std::int64_t>(MostSent(pieces, processes) + MostReceived(pieces, processes) +
                                   gathered);
}

void GradientExchange::together(const std::function<void()>& work)
{
  Timer clock;
  this->Group.together([&] {
    work();
    clock = Timer();
  });
  this->Times.waiting += clock.seconds();
}

std::optional<double> GradientExchange::sum(const std::optional<double>& loss, float* weights,
                                            std::size_t count, GridGradient& grid)
{
  const Timer clock;
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
  const std::size_t atATime = PiecesAtATime(pieces, this->Group.size());
  this->makeRoom(pieces);
  for (std::size_t begin = 0; begin < pieces; begin += atATime) {
    this->sumPieces(grid, begin, std::min(begin + atATime, pieces));
  }
  this->Times.exchanging += clock.seconds();
  return total;
}

/// At once: what grows by and by is copied, and takes up to twice the memory.
void GradientExchange::makeRoom(std::size_t pieces)
{
  this->Sent.reserve(MostSent(pieces, this->Group.size()));
  this->Received.bytes.reserve(MostReceived(pieces, this->Group.size()));
}

void GradientExchange::sumPieces(GridGradient& grid, std::size_t begin, std::size_t end)
{
  const auto size = static_cast<std::size_t>(this->Group.size());
  const auto rank = static_cast<std::size_t>(this->Group.rank());
  std::vector<Pieces> shares(size);
  for (std::size_t k = begin; k < end; ++k) {
    shares[k % size].push_back(&grid.pieces()[k]);
  }
  std::vector<std::size_t> begins = {0};
  for (const Pieces& share : shares) {
    begins.push_back(this->pack(grid, share, begins.back()));
  }
  this->Group.distribute(this->Sent.data(), begins, this->Received);
  std::vector<const char*> messages;
  for (const std::size_t at : this->Received.begins) {
    messages.push_back(this->Received.bytes.data() + at);
  }
  this->addUp(grid, shares[rank], messages);
  const std::size_t count = this->pack(grid, shares[rank], 0);
  this->Group.gatherInto(this->Sent.data(), count, this->Received);
  for (std::size_t k = 0; k < size; ++k) {
    if (k != rank) {
      this->addUp(grid, shares[k], {this->Received.bytes.data() + this->Received.begins[k]});
    }
  }
}

/// Writes a message: where each part begins, then the parts. Returns where it ends.
std::size_t GradientExchange::pack(GridGradient& grid, const Pieces& pieces, std::size_t at)
{
  const auto tasks = static_cast<std::int64_t>(pieces.size());
  std::vector<std::uint64_t> begins(pieces.size() + 1, pieces.size() * sizeof(std::uint64_t));
  this->Threads.forEachBlock(tasks, 1, [&](std::int64_t k, std::int64_t) {
    begins[static_cast<std::size_t>(k) + 1] = PartSize(*pieces[static_cast<std::size_t>(k)]);
  });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  this->Sent.resize(std::max(this->Sent.size(), at + begins.back()));
  char* const message = this->Sent.data() + at;
  std::memcpy(message, begins.data(), pieces.size() * sizeof(std::uint64_t));
  this->Threads.forEachBlock(tasks, 1, [&](std::int64_t k, std::int64_t) {
    const GridGradient::Piece& piece = *pieces[static_cast<std::size_t>(k)];
    WritePart(piece, grid.values(piece), message + begins[static_cast<std::size_t>(k)]);
  });
  return at + begins.back();
}

/// Enters into the grid what messages about the same pieces come to.
void GradientExchange::addUp(GridGradient& grid, const Pieces& pieces,
                             const std::vector<const char*>& messages) const
{
  const auto tasks = static_cast<std::int64_t>(pieces.size());
  this->Threads.forEachBlock(tasks, 1, [&](std::int64_t k, std::int64_t) {
    const GridGradient::Piece& piece = *pieces[static_cast<std::size_t>(k)];
    std::vector<PartReader> parts;
    for (const char* const message : messages) {
      const char* const part =
          message + FromBytes<std::uint64_t>(message + k * sizeof(std::uint64_t));
      parts.push_back({part, part + LinesOf(piece)});
    }
    AddParts(piece, grid.values(piece), parts);
  });
}

} // namespace inr
