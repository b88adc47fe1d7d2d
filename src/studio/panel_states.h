// What the panels remember from one frame of the window to the next; nothing here is part of the
// session. Each is declared by its panel, and nobody else need know what is in it.
#pragma once

#include <memory>

namespace livery {

struct LibraryPanelState;
struct PaintPanelState;
struct ArtworkPanelState;
struct LightingPanelState;
struct PlanPanelState;
struct CalibrationPanelState;
struct BallotPanelState;
struct CapturePanelState;
struct LookThumbnailState;
struct NudgePanelState;
struct PresentingState;
struct SeatsPanelState;
struct ReportWindowState;

/// Always there. Owns textures: destroy it with the window's context current.
struct PanelStates {
    PanelStates();
    ~PanelStates();
    PanelStates(PanelStates&&) noexcept;
    PanelStates& operator=(PanelStates&&) noexcept;

    std::unique_ptr<LibraryPanelState> library;
    std::unique_ptr<PaintPanelState> paint;
    std::unique_ptr<ArtworkPanelState> artwork;
    std::unique_ptr<LightingPanelState> lighting;
    std::unique_ptr<PlanPanelState> plan;
    std::unique_ptr<CalibrationPanelState> calibration;
    std::unique_ptr<BallotPanelState> ballot;
    std::unique_ptr<CapturePanelState> capture;
    std::unique_ptr<LookThumbnailState> thumbnails;
    std::unique_ptr<NudgePanelState> nudge;
    std::unique_ptr<PresentingState> presenting;
    std::unique_ptr<SeatsPanelState> seats;
    std::unique_ptr<ReportWindowState> report;
};

}  // namespace livery
