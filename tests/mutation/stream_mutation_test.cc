#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/crc32c.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_header.h"
#include "core/stream/stream_file.h"
#include "tests/mutation/mutate.h"
#include "tests/unit/core/stream/golden_scene.h"

namespace cleave {
namespace {

using stream_test::GoldenStream;
using stream_test::kGoldenDirectory;
using stream_test::kGoldenStreams;

std::string Load(const std::string& name) {
  std::ifstream file(kGoldenDirectory + name, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

template <typename T>
std::vector<T> LoadAll(const std::string& name) {
  const std::string raw = Load(name);
  std::vector<T> all(raw.size() / sizeof(T));
  std::memcpy(all.data(), raw.data(), all.size() * sizeof(T));
  return all;
}

// A golden stream taken apart: labels, lists, motion with and without classes, holds, epochs, a
// change of tolerance.
struct Corpus {
  explicit Corpus(const GoldenStream& golden)
      : bytes(Load(std::string(golden.name) + ".clv")),
        rest(LoadAll<Vec3>(std::string(golden.name) + ".rest")) {
    if (golden.interpolates()) {
      edges = LoadAll<std::array<int32_t, 2>>(std::string(golden.name) + ".edges");
    }
    if (golden.surface) {
      tets = LoadAll<std::array<int32_t, 4>>(std::string(golden.name) + ".tets");
    }
    const BufferAccess file(bytes);
    const auto reader = StreamFileReader::Open(file);
    EXPECT_TRUE(reader.ok()) << reader.status();
    header = reader->header_bytes();
    frames_end = reader->frames_end();
    rows = reader->rows();
    for (size_t at = 0; at < rows.size(); ++at) frames.push_back(*reader->ReadFrame(at));
  }
  StreamMesh mesh() const { return {rest, edges, tets}; }

  std::string bytes;
  std::vector<Vec3> rest;
  std::vector<std::array<int32_t, 2>> edges;
  std::vector<std::array<int32_t, 4>> tets;
  std::string header;
  uint64_t frames_end = 0;
  std::vector<IndexRow> rows;
  std::vector<std::string> frames;
};

template <typename T>
void Store(std::string& bytes, size_t at, T value) {
  if (at + sizeof(T) <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof(T));
}

// Makes lengths and checksums of a damaged frame right, as an attacker would, as far as they lead.
void MakeFrameRight(std::string& frame, Dice& dice) {
  if (frame.size() < kFrameHeaderBytes) return;
  if (!dice.OneIn(4)) Store<uint64_t>(frame, 8, frame.size());
  Store(frame, 84, Crc32c(absl::string_view(frame).substr(0, 84)));
  for (size_t at = kFrameHeaderBytes; at + kSectionHeaderBytes <= frame.size();) {
    const size_t left = frame.size() - at - kSectionHeaderBytes;
    uint32_t coded = 0;
    std::memcpy(&coded, frame.data() + at + 8, sizeof(coded));
    if (coded > left) {
      coded = static_cast<uint32_t>(left);
      Store(frame, at + 8, coded);
    }
    const absl::string_view all = frame;
    Store(frame, at + 20,
          Crc32c(all.substr(at + kSectionHeaderBytes, coded), Crc32c(all.substr(at, 20))));
    at += kSectionHeaderBytes + coded;
  }
}

// Damage behind the frame's header, mostly, since it is the sections that are decoded.
std::string Forge(const Corpus& corpus, size_t position, Dice& dice) {
  const std::string& frame = corpus.frames[position];
  std::string forged;
  switch (dice.Roll(4)) {
    case 3:  // of the same length, so that it is the decoders behind that must see it
      forged = frame;
      for (uint64_t changes = dice.Roll(4) + 1; changes > 0; --changes) {
        forged[dice.Roll(forged.size())] = static_cast<char>(dice.Roll(256));
      }
      break;
    case 0:
      forged = MutateBytes(frame, dice);
      break;
    case 1:
      forged = frame.substr(0, kFrameHeaderBytes) +
               MutateBytes(absl::string_view(frame).substr(kFrameHeaderBytes), dice);
      break;
    default: {
      // A few bytes of another frame in the place of its own.
      const std::string& other = corpus.frames[dice.Roll(corpus.frames.size())];
      forged = frame;
      const size_t at = dice.Roll(forged.size());
      forged.replace(at, dice.Roll(40), other, dice.Roll(other.size()), dice.Roll(40));
    }
  }
  MakeFrameRight(forged, dice);
  return forged;
}

TEST(StreamMutation, ForgedFramesAreRefusedAndChangeNothingOrAreRight) {
  constexpr uint64_t kRounds = 230;
  int inputs = 0;
  int right = 0;
  for (const GoldenStream& golden : kGoldenStreams) {
    SCOPED_TRACE(golden.name);
    const Corpus corpus(golden);
    auto decoder = FrameDecoder::Create(corpus.header, corpus.mesh());
    ASSERT_TRUE(decoder.ok()) << decoder.status();
    for (size_t position = 0; position < corpus.frames.size(); ++position) {
      const StreamState before = decoder->state();
      for (uint64_t round = 0; round < kRounds; ++round) {
        SCOPED_TRACE(round);
        Dice dice(1000 * position + round);
        const std::string forged = Forge(corpus, position, dice);
        ++inputs;
        const absl::Status status = decoder->Apply(forged);
        if (!status.ok()) {
          ASSERT_LT(status.message().size(), 1000u);
          ASSERT_EQ(decoder->state().frame, before.frame);
          ASSERT_EQ(decoder->state().positions, before.positions);
          if (before.has_previous) {
            ASSERT_EQ(decoder->state().previous, before.previous);
          }
          ASSERT_EQ(decoder->state().exact, before.exact);
          ASSERT_EQ(decoder->state().shifts, before.shifts);
          ASSERT_EQ(decoder->state().broken_edges, before.broken_edges);
          continue;
        }
        // What is accepted is a frame of the stream, bit for bit.
        ++right;
        bool known = false;
        for (const IndexRow& row : corpus.rows) known |= row.state_hash == decoder->state_hash();
        ASSERT_TRUE(known);
        ASSERT_EQ(HashStreamState(corpus.header, decoder->state()), decoder->state_hash());
        decoder = FrameDecoder::Create(corpus.header, corpus.mesh());
        const BufferAccess file(corpus.bytes);
        const auto reader = StreamFileReader::Open(file);
        if (position > 0) {
          ASSERT_TRUE(reader->Seek(position - 1, *decoder).ok());
        }
      }
      ASSERT_TRUE(decoder->Apply(corpus.frames[position]).ok()) << position;
      ASSERT_EQ(decoder->state_hash(), corpus.rows[position].state_hash);
    }
  }
  EXPECT_GT(inputs, 10'000);
  EXPECT_GT(right, 0);
}

TEST(StreamMutation, ForgedStreamHeadersAreRefusedOrDecodeNothing) {
  int inputs = 0;
  int accepted = 0;
  for (const GoldenStream& golden : kGoldenStreams) {
    const Corpus corpus(golden);
    for (uint64_t round = 0; round < 2600; ++round) {
      SCOPED_TRACE(round);
      Dice dice(round);
      std::string forged = dice.OneIn(2) ? MutateBytes(corpus.header, dice) : corpus.header;
      for (uint64_t changes = dice.Roll(3); changes > 0 && forged.size() > 8; --changes) {
        Store(forged, 4 + dice.Roll(forged.size() - 8), dice.Roll(~uint64_t{0}));
      }
      if (forged.size() >= 16) {
        if (!dice.OneIn(4)) Store(forged, 8, static_cast<uint32_t>(forged.size()));
        Store(forged, forged.size() - 4,
              Crc32c(absl::string_view(forged).substr(0, forged.size() - 4)));
      }
      ++inputs;
      auto decoder = FrameDecoder::Create(forged, corpus.mesh());
      if (!decoder.ok()) continue;
      ++accepted;  // what it must not know is reserved, informative or optional
      ASSERT_EQ(decoder->Apply(corpus.frames[0]).ok(), forged == corpus.header);
    }
  }
  EXPECT_GT(inputs, 10'000);
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, inputs);
}

TEST(StreamMutation, ForgedFilesShowRightFramesOrNone) {
  int inputs = 0;
  int shown = 0;
  for (const GoldenStream& golden : kGoldenStreams) {
    const Corpus corpus(golden);
    for (uint64_t round = 0; round < 2600; ++round) {
      SCOPED_TRACE(round);
      Dice dice(round);
      // Damage to the index; every row's checksum and the trailer's are made right.
      const std::string footer = corpus.bytes.substr(corpus.frames_end);
      std::string forged = MutateBytes(footer, dice);
      for (size_t row = 16; row + kIndexRowBytes + 24 <= forged.size(); row += kIndexRowBytes) {
        Store(forged, row + kIndexRowBytes - 4,
              Crc32c(absl::string_view(forged).substr(row, kIndexRowBytes - 4)));
      }
      if (forged.size() > 40) {
        if (dice.OneIn(2)) Store<uint64_t>(forged, 8, (forged.size() - 40) / kIndexRowBytes);
        if (!dice.OneIn(4)) Store<uint64_t>(forged, forged.size() - 24, corpus.frames_end);
        if (!dice.OneIn(4)) Store<uint64_t>(forged, forged.size() - 16, forged.size() - 24);
        Store(forged, forged.size() - 8,
              Crc32c(absl::string_view(forged).substr(0, forged.size() - 8)));
      }
      forged.insert(0, corpus.bytes, 0, corpus.frames_end);
      ++inputs;
      const BufferAccess file(forged);
      const auto reader = StreamFileReader::Open(file);
      ASSERT_TRUE(reader.ok()) << reader.status();  // frames and header are whole
      ASSERT_LE(reader->rows().size(), forged.size() / kFrameHeaderBytes + corpus.rows.size());
      if (reader->rows().empty()) continue;
      const size_t position = dice.Roll(reader->rows().size());
      const auto bytes = reader->ReadFrame(position);
      if (!bytes.ok()) continue;
      const IndexRow& row = reader->rows()[position];
      bool known = false;
      for (const IndexRow& of_stream : corpus.rows) {
        known |= of_stream.frame == row.frame && of_stream.epoch == row.epoch &&
                 of_stream.state_hash == row.state_hash;
      }
      ASSERT_TRUE(known);
      ++shown;
    }
  }
  EXPECT_GT(inputs, 10'000);
  EXPECT_GT(shown, inputs / 100);
}

}  // namespace
}  // namespace cleave
