#include "studio/panel_states.h"

#include "studio/artwork/artwork_panel.h"
#include "studio/ballot_panel.h"
#include "studio/calibration_panel.h"
#include "studio/capture/capture_panel.h"
#include "studio/light/lighting_panel.h"
#include "studio/look_thumbnails.h"
#include "studio/nudge/nudge_panel.h"
#include "studio/paint/library_panel.h"
#include "studio/paint/paint_panel.h"
#include "studio/plan_panel.h"
#include "studio/presenting/presenting.h"
#include "studio/report/report_window.h"
#include "studio/seats/seats_panel.h"

namespace livery {

PanelStates::PanelStates()
    : library(std::make_unique<LibraryPanelState>()),
      paint(std::make_unique<PaintPanelState>()),
      artwork(std::make_unique<ArtworkPanelState>()),
      lighting(std::make_unique<LightingPanelState>()),
      plan(std::make_unique<PlanPanelState>()),
      calibration(std::make_unique<CalibrationPanelState>()),
      ballot(std::make_unique<BallotPanelState>()),
      capture(std::make_unique<CapturePanelState>()),
      thumbnails(std::make_unique<LookThumbnailState>()),
      nudge(std::make_unique<NudgePanelState>()),
      presenting(std::make_unique<PresentingState>()),
      seats(std::make_unique<SeatsPanelState>()),
      report(std::make_unique<ReportWindowState>()) {}

PanelStates::~PanelStates() = default;
PanelStates::PanelStates(PanelStates&&) noexcept = default;
PanelStates& PanelStates::operator=(PanelStates&&) noexcept = default;

}  // namespace livery
