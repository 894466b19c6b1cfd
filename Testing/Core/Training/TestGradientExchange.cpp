// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Random.h"
#include "Core/Training/Descent/GradientExchange.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/ThreadGroup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

namespace test::gradient_exchange {

constexpr int Size = 3;
constexpr std::size_t Weights = 21;

/// What a process has: random numbers in some lines of the grid, fewer of them the finer the level,
/// zeros elsewhere.
class Share
{
public:
  Share(const inr::Description& description, int rank)
      : Shape(description), Parameters(this->Shape.parameterCount),
        Views(description, this->Shape, this->Parameters.data()),
        GridValues(this->Shape.parameterCount - this->Shape.gridOffset),
        Grid(this->Views.view(), this->GridValues.data())
  {
    std::uint64_t drawn = 0;
    const auto random = [&] { return inr::RandomUnit(static_cast<std::uint64_t>(rank), drawn++); };
    for (std::size_t k = 0; k < Weights; ++k) {
      this->Network.push_back(random() - 0.5f);
    }
    for (std::size_t k = 0; k < this->Grid.pieces().size(); ++k) {
      const inr::GridGradient::Piece& piece = this->Grid.pieces()[k];
      for (std::int64_t at = 0; at < piece.count; ++at) {
        std::uint8_t& touched = piece.touched[at / inr::GradientLine];
        if (at % inr::GradientLine == 0) {
          touched = random() < 1.0f / static_cast<float>(1 + k % 5) ? 1 : 0;
        }
        // Of many sizes: their sum depends on the order.
        this->Grid.values(piece)[at] = touched != 0 ? (random() - 0.5f) / (0.01f + random()) : 0.0f;
      }
    }
  }

  void touchAll()
  {
    for (const inr::GridGradient::Piece& piece : this->Grid.pieces()) {
      std::fill_n(piece.touched, (piece.count + inr::GradientLine - 1) / inr::GradientLine, 1);
    }
  }

  std::vector<std::uint8_t> touched() const
  {
    std::vector<std::uint8_t> all;
    for (const inr::GridGradient::Piece& piece : this->Grid.pieces()) {
      const std::int64_t lines = (piece.count + inr::GradientLine - 1) / inr::GradientLine;
      all.insert(all.end(), piece.touched, piece.touched + lines);
    }
    return all;
  }

private:
  inr::Layout Shape;
  std::vector<float> Parameters;
  inr::ModelViewStorage Views;

public:
  std::vector<float> Network;
  std::vector<float> GridValues;
  inr::GridGradient Grid;
};

/// Keeps account of what a process has to hold at most: of megabytes what is sent and what comes in
/// return, and of the rest what all give, twice where it is put together first.
class CountingGroup : public inr::TrainingGroup
{
public:
  explicit CountingGroup(const inr::TrainingGroup& group) : Group(group) {}

  std::int64_t bytes() const { return this->Sent + this->Received + this->Gathered; }

  int rank() const override { return this->Group.rank(); }
  int size() const override { return this->Group.size(); }
  std::vector<std::string> gather(const std::string& bytes) const override
  {
    const auto own = static_cast<std::int64_t>(bytes.size());
    this->Gathered = std::max(this->Gathered, own + 2 * this->size() * own);
    return this->Group.gather(bytes);
  }
  void gatherInto(const char* bytes, std::size_t count, inr::GatheredBytes& all) const override
  {
    this->Group.gatherInto(bytes, count, all);
    this->count(count, all.bytes.size());
  }
  void distribute(const char* bytes, const std::vector<std::size_t>& begins,
                  inr::GatheredBytes& mine) const override
  {
    this->Group.distribute(bytes, begins, mine);
    this->count(begins.back(), mine.bytes.size());
  }

private:
  void count(std::size_t sent, std::size_t received) const
  {
    this->Sent = std::max(this->Sent, static_cast<std::int64_t>(sent));
    this->Received = std::max(this->Received, static_cast<std::int64_t>(received));
  }

  const inr::TrainingGroup& Group;
  mutable std::int64_t Sent = 0;
  mutable std::int64_t Received = 0;
  mutable std::int64_t Gathered = 0;
};

/// One rank's after the other.
void Add(std::vector<float>& sum, const std::vector<float>& share)
{
  sum.resize(share.size());
  for (std::size_t k = 0; k < share.size(); ++k) {
    sum[k] += share[k];
  }
}

/// More than a message holds, and levels that end in the middle of a line.
std::vector<inr::Description> Descriptions()
{
  inr::Description large = SmallDescription();
  large.grid.levels = 6;
  large.grid.log2HashmapSize = 16;
  large.grid.baseResolution = 20;
  inr::Description odd = SmallDescription();
  odd.grid.features = 1;
  odd.grid.log2HashmapSize = 2;
  return {large, odd};
}

TEST(GradientExchange, GivesAllTheSumInTheOrderOfRanks)
{
  for (const inr::Description& description : Descriptions()) {
    std::vector<float> network;
    std::vector<float> grid;
    std::vector<std::uint8_t> touched;
    for (int rank = 0; rank < Size; ++rank) {
      const Share share(description, rank);
      Add(network, share.Network);
      Add(grid, share.GridValues);
      const std::vector<std::uint8_t> marks = share.touched();
      touched.resize(marks.size());
      std::transform(marks.begin(), marks.end(), touched.begin(), touched.begin(),
                     std::bit_or<std::uint8_t>());
    }
    InGroup(Size, [&](const ThreadGroup& group) {
      Share share(description, group.rank());
      const inr::Arena arena(2);
      inr::GradientExchange exchange(group, arena);
      const std::optional<double> loss =
          exchange.sum(group.rank() + 0.5, share.Network.data(), Weights, share.Grid);
      EXPECT_EQ(loss, 4.5);
      EXPECT_EQ(share.Network, network);
      EXPECT_EQ(share.GridValues, grid);
      EXPECT_EQ(share.touched(), touched);
    });
  }
}

// What is set aside for it is what it takes, where all lines are touched and where few are.
TEST(GradientExchange, TakesTheMemoryThatIsSetAsideForIt)
{
  inr::Description large = SmallDescription();
  large.grid.levels = 12;
  large.grid.log2HashmapSize = 17;
  large.grid.baseResolution = 30;
  for (const inr::Description& description : {large, SmallDescription()}) {
    for (const int size : {2, 3, 5}) {
      const inr::Layout shape(description);
      const std::int64_t aside = inr::ExchangeBytes(shape, size);
      InGroup(size, [&](const ThreadGroup& threads) {
        const CountingGroup group(threads);
        const inr::Arena arena(1);
        inr::GradientExchange exchange(group, arena);
        std::vector<float> network(shape.gridOffset);
        std::int64_t first = 0;
        for (const bool all : {false, true}) {
          Share share(description, group.rank());
          all ? share.touchAll() : void();
          exchange.sum(1.0, network.data(), network.size(), share.Grid);
          first = all ? first : exchange.bytesHeld();
        }
        EXPECT_EQ(exchange.bytesHeld(), first) << "has grown";
        EXPECT_LE(exchange.bytesHeld(), aside);
        EXPECT_LE(group.bytes(), aside);
        if (description == large) { // the other's pieces are far from full
          EXPECT_GT(group.bytes(), 0.8 * static_cast<double>(aside)) << size;
        }
      });
    }
  }
}

TEST(GradientExchange, GivesNothingWhereOneWasStopped)
{
  InGroup(Size, [&](const ThreadGroup& group) {
    Share share(SmallDescription(), group.rank());
    const inr::Arena arena(1);
    inr::GradientExchange exchange(group, arena);
    const auto loss = group.rank() == 1 ? std::optional<double>() : 1.0;
    EXPECT_FALSE(exchange.sum(loss, share.Network.data(), Weights, share.Grid).has_value());
    EXPECT_EQ(share.GridValues, Share(SmallDescription(), group.rank()).GridValues);
  });
}

} // namespace test::gradient_exchange
