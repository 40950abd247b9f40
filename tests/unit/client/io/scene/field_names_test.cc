#include "client/io/scene/field_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cleave/v1/scene.pb.h"

namespace cleave {
namespace {

TEST(FieldNames, NearestIsFoundForTyposCaseSwapsAndParts) {
  const std::vector<std::string> names = {"youngs_modulus", "poisson_ratio", "density"};
  EXPECT_EQ(NearestName("youngs_moduls", names), "youngs_modulus");
  EXPECT_EQ(NearestName("Youngs_Modulus", names), "youngs_modulus");
  EXPECT_EQ(NearestName("posson_raito", names), "poisson_ratio");
  EXPECT_EQ(NearestName("modulus", names), "youngs_modulus");
  EXPECT_EQ(NearestName("density_kg", names), "density");
}

TEST(FieldNames, NothingIsGuessedWhenNothingIsNear) {
  EXPECT_EQ(NearestName("colour", {"youngs_modulus", "density"}), "");
  EXPECT_EQ(NearestName("", {"density"}), "");
  EXPECT_EQ(NearestName(std::string(10000, 'd'), {"density"}), "");
}

TEST(FieldNames, ShortEnumNameFindsItsFullName) {
  EXPECT_EQ(NearestName("X", {"AXIS_UNSPECIFIED", "AXIS_X", "AXIS_Y"}), "AXIS_X");
}

TEST(FieldNames, UnknownFieldNamesMessageInWords) {
  EXPECT_EQ(UnknownFieldText(*v1::MeshResolution::descriptor(), "cellsize"),
            "mesh resolution field \"cellsize\" is unknown; did you mean \"cell_size\"?");
  EXPECT_EQ(
      UnknownFieldText(*v1::MeshResolution::descriptor(), "colour"),
      "mesh resolution field \"colour\" is unknown; there are: layout, cell_size, jitter, seed");
  EXPECT_EQ(UnknownFieldText(*v1::BandField::descriptor(), "widht"),
            "band field \"widht\" is unknown; did you mean \"width\"?");
}

}  // namespace
}  // namespace cleave
