// For tests that run once on every instruction set that this machine has.
#pragma once

#include "tracer/accel/trace_rays.h"

#include <gtest/gtest.h>

#include <string>

namespace raypick {

class OnInstructionSet : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override { use_instruction_set(GetParam()); }
    void TearDown() override { use_instruction_set(""); }
};

inline std::string instruction_set_name(const testing::TestParamInfo<std::string>& set) {
    return set.param;
}

}  // namespace raypick

// Runs the TEST_Ps of a fixture that derives from OnInstructionSet.
#define RAYPICK_ON_EACH_INSTRUCTION_SET(Fixture)                                              \
    INSTANTIATE_TEST_SUITE_P(InstructionSets, Fixture, testing::ValuesIn(instruction_sets()), \
                             instruction_set_name)
