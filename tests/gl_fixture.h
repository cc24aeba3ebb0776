// A context for tests that draw: made in one place, and the code under test doesn't know which.
#pragma once

#include "tests/needs.h"
#include "viewer/headless/offscreen_context.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace raypick {

class GlTest : public ::testing::Test {
protected:
    void SetUp() override {
        std::string reason;
        try {
            context_ = std::make_unique<OffscreenContext>();
        } catch (const NoOpenGL& error) {
            reason = error.what();
        }
        RAYPICK_REQUIRE(context_ != nullptr, reason);
    }

    std::unique_ptr<OffscreenContext> context_;
};

}  // namespace raypick
