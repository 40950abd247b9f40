#include "client/io/mesh/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include "client/io/mesh/file_bytes.h"
#include "tests/unit/client/io/mesh/sample_files.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string MessageOf(const absl::StatusOr<TetMesh>& mesh) {
  return std::string(mesh.status().message());
}

std::string Compressed(absl::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  return out;
}

TEST(MeshFile, NamesThePathOfWhatIsWrong) {
  EXPECT_EQ(ReadMeshFile("/no/such/mesh.msh").status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(MessageOf(ReadMeshFile("/no/such/mesh.msh")), HasSubstr("/no/such/mesh.msh"));
  EXPECT_FALSE(ReadMeshFile(CLEAVE_SOURCE_DIR).ok());
  EXPECT_EQ(MessageOf(ParseMeshFile("", "a.msh")), "a.msh: the file is empty");
  EXPECT_THAT(MessageOf(ParseMeshFile("hello", "a.msh")), HasSubstr("a.msh: line 1: expected"));
  EXPECT_THAT(MessageOf(ParseMeshFile("hello", "a.txt")), HasSubstr("format is not known"));
}

TEST(MeshFile, SaysWhatToDoWithSurfaces) {
  for (const char* name : {"a.obj", "b.PLY", "dir.msh/c.stl", "d.off"}) {
    EXPECT_THAT(MessageOf(ParseMeshFile("v 0 0 0", name)),
                AllOf(HasSubstr("surface"), HasSubstr("TetGen")));
  }
  EXPECT_THAT(MessageOf(ParseMeshFile("ply\nformat ascii 1.0\n", "noname")), HasSubstr("surface"));
}

TEST(MeshFile, BundledSpecimenHasItsThreeParts) {
  const absl::StatusOr<TetMesh> mesh =
      ReadMeshFile(CLEAVE_SOURCE_DIR "/tests/scenes/meshes/tensile_bar.msh");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->tet_count(), 7208);
  EXPECT_EQ(mesh->node_count(), 2189);
  ASSERT_EQ(mesh->regions.size(), 3u);
  EXPECT_EQ(mesh->regions[0].name, "grip_left");
  EXPECT_EQ(mesh->regions[1].name, "gauge");
  EXPECT_EQ(mesh->regions[2].name, "grip_right");
}

class MeshFileOnDisk : public ::testing::Test {
 protected:
  std::string Write(absl::string_view name, absl::string_view bytes) const {
    const std::string path = directory_ / std::string(name);
    WriteBytes(path, std::string(bytes));
    return path;
  }

 private:
  const TemporaryDirectory directory_;
};

TEST_F(MeshFileOnDisk, EitherTetGenFileLeadsToBoth) {
  const std::string node = Write("body.1.node", samples::kTetGenNode);
  EXPECT_EQ(ReadMeshFile(node).status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(MessageOf(ReadMeshFile(node)), HasSubstr("body.1.ele"));
  const std::string ele = Write("body.1.ele.zst", Compressed(samples::kTetGenEle));
  for (const std::string& path : {node, ele}) {
    const absl::StatusOr<TetMesh> mesh = ReadMeshFile(path);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->tet_count(), 2);
  }
}

TEST_F(MeshFileOnDisk, CompressedFilesAreReadWhateverTheirName) {
  for (const auto& [name, bytes] : samples::All()) {
    EXPECT_TRUE(ReadMeshFile(Write(name, Compressed(bytes))).ok()) << name;
    EXPECT_TRUE(ReadMeshFile(Write(name + ".zst", Compressed(bytes))).ok()) << name;
  }
}

TEST(DecompressZstd, IsBoundedAndRefusesDamage) {
  const std::string zeros(3'000'000, '\0');
  const std::string packed = Compressed(zeros);
  EXPECT_EQ(DecompressZstd(packed, zeros.size()).value(), zeros);
  EXPECT_EQ(DecompressZstd(packed + packed, 2 * zeros.size()).value().size(), 2 * zeros.size());
  EXPECT_THAT(std::string(DecompressZstd(packed, 1'000'000).status().message()),
              HasSubstr("more than 1000000 bytes"));
  for (size_t size = 0; size < packed.size(); ++size) {
    const absl::StatusOr<std::string> cut =
        DecompressZstd(absl::string_view(packed).substr(0, size), zeros.size());
    EXPECT_TRUE(!cut.ok() || cut->empty()) << size;
  }
  std::string damaged = packed;
  damaged[5] = static_cast<char>(damaged[5] ^ 0x55);
  DecompressZstd(damaged, zeros.size()).status().IgnoreError();
}

}  // namespace
}  // namespace cleave
