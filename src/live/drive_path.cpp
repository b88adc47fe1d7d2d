#include "live/drive_path.h"

#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compensation/gpu_pass.h"
#include "core/colour.h"
#include "core/parallel.h"
#include "core/recycler.h"
#include "gl/draw.h"
#include "gl/timer.h"
#include "jobs/comparison.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;
using Slot = TexturePool::Slot;

std::shared_ptr<const Slot> finished(std::shared_ptr<Slot> slot) {
    slot->ready = Fence::after_everything_so_far();
    return slot;
}

class ProcessorDrivePath : public DrivePath {
  public:
    FramePicture<ImageF> take(const RadianceRenderer& renderer) override {
        return {renderer.picture(), nullptr};
    }

    FramePicture<Image8> correct(std::size_t side,
                                 const std::shared_ptr<const ProjectorSetup>& setup,
                                 const FramePicture<ImageF>& radiance,
                                 std::size_t covered_pixels) override {
        const auto start = Clock::now();
        Measured& measured = measured_[side] = {};
        std::shared_ptr<Image8> drive;
        if (setup->table) {
            if (corrected_.of != setup) corrected_ = {setup, std::make_unique<Recycler<Image8>>()};
            drive = corrected_.pictures->take();
            compensate_again(
                *setup->table, *radiance.image, covered_pixels, drive.get(), &measured.stats);
        } else {
            drive = drives_.take();
            srgb_from_working_into(*radiance.image, drive.get());
        }
        measured.ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        return {std::move(drive), nullptr};
    }

    Measured measured(std::size_t side) override { return measured_[side]; }

    FramePicture<Image8> show(FramePicture<Image8> drive) override {
        const Image8& image = *drive.image;
        rgba_.resize(4 * image.pixel_count(), 255);
        const std::uint8_t* from = image.values.data();
        std::uint8_t* to = rgba_.data();
        parallel_for(image.pixel_count(), 65536, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                for (std::size_t c = 0; c < 3; ++c) to[4 * i + c] = from[3 * i + c];
            }
        });
        auto slot = textures_.lend(image.width, image.height);
        slot->texture.upload(std::span<const std::uint8_t>(rgba_));
        drive.slot = finished(std::move(slot));
        return drive;
    }

    FramePicture<Image8> join(const FramePicture<Image8>& left,
                              const FramePicture<Image8>& right,
                              int column) override {
        auto joined = drives_.take();
        join_columns(*left.image, *right.image, column, joined.get());
        return show({std::move(joined), nullptr});
    }

    int programs() const override { return 0; }
    int textures() const override { return textures_.made(); }

  private:
    /// Corrected pictures of one setup: what lies beside the mock-up stays black in them.
    struct Corrected {
        std::shared_ptr<const ProjectorSetup> of;
        std::unique_ptr<Recycler<Image8>> pictures;
    };
    Corrected corrected_;
    Recycler<Image8> drives_;  ///< of both sides of a wipe, and those that nothing corrects
    std::array<Measured, 2> measured_;
    std::vector<std::uint8_t> rgba_;
    TexturePool textures_{TexelFormat::rgba8};
};

class GlDrivePath : public DrivePath {
  public:
    FramePicture<ImageF> take(const RadianceRenderer& renderer) override {
        const SurfaceMap& map = renderer.surface_map();
        auto slot = radiances_.lend(map.width, map.height);
        copy_texels(renderer.texture(), slot->texture, {0, 0, map.width, map.height});
        return {nullptr, finished(std::move(slot))};
    }

    FramePicture<Image8> correct(std::size_t side,
                                 const std::shared_ptr<const ProjectorSetup>& setup,
                                 const FramePicture<ImageF>& radiance,
                                 std::size_t covered_pixels) override {
        const Texture2D& wanted = radiance.slot->texture;
        auto slot = drives_.lend(wanted.width(), wanted.height());
        if (setup->table && corrects_for_ != setup) {
            corrects_for_ = nullptr;  // until it worked
            correction_.use(*setup->table);
            corrects_for_ = setup;
        }
        if (!setup->table && !srgb_) srgb_ = srgb_program();
        UnderWay& run = under_way_[side];
        run.covered_pixels = setup->table ? std::optional(covered_pixels) : std::nullopt;
        run.timer.start();
        // Drivers that draw later and compute at once would stamp both ends after the work.
        flush_gl();
        if (setup->table) {
            correction_.run(wanted.name(), slot->texture, run.counts);
        } else {
            wanted.bind(0);
            screen_.run(*srgb_, slot->framebuffer);
        }
        run.timer.stop();
        return {nullptr, finished(std::move(slot))};
    }

    Measured measured(std::size_t side) override {
        const UnderWay& run = under_way_[side];
        Measured measured;
        measured.ms = run.timer.milliseconds();
        if (run.covered_pixels) measured.stats = run.counts.read(*run.covered_pixels);
        return measured;
    }

    FramePicture<Image8> show(FramePicture<Image8> drive) override { return drive; }

    FramePicture<Image8> join(const FramePicture<Image8>& left,
                              const FramePicture<Image8>& right,
                              int column) override {
        const Texture2D& texture = left.slot->texture;
        const int width = texture.width(), height = texture.height();
        auto slot = drives_.lend(width, height);
        copy_texels(texture.name(), slot->texture, {0, 0, column, height});
        copy_texels(right.slot->texture.name(), slot->texture, {column, 0, width - column, height});
        return {nullptr, finished(std::move(slot))};
    }

    int programs() const override { return correction_.programs() + (srgb_ ? 1 : 0); }
    int textures() const override { return radiances_.made() + drives_.made(); }

  private:
    static Program srgb_program() {
        Program program = Program::screen_pass(load_shader("compensation/srgb.frag"));
        program.set("rec709_from_working", glm::mat3(rec709_from_working()));
        return program;
    }

    struct UnderWay {
        CompensationCounts counts;
        GlTimer timer;
        std::optional<std::size_t> covered_pixels;  ///< none: nothing was counted
    };
    std::array<UnderWay, 2> under_way_;
    std::shared_ptr<const ProjectorSetup> corrects_for_;
    GpuCompensation correction_;
    std::optional<Program> srgb_;
    ScreenPass screen_;
    TexturePool radiances_{TexelFormat::rgba16f}, drives_{TexelFormat::rgba8};
};

}  // namespace

std::unique_ptr<DrivePath> make_drive_path(ShadingDevice device) {
    if (device == ShadingDevice::gl) return std::make_unique<GlDrivePath>();
    return std::make_unique<ProcessorDrivePath>();
}

}  // namespace livery
