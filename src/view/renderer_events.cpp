// SPDX-License-Identifier: GPL-3.0-or-later
// News of the renderers, and the progress of an image.
#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>

#include "view/view_json.h"
#include "view/view_server_state.h"

namespace opaline {
namespace {

constexpr std::chrono::milliseconds kTick{100};

}  // namespace

ViewEvents ViewServer::State::renderer_events() {
  return {[this](std::uint32_t revision, const Scene& scene, const Plan& plan, std::span<const Bounds> all) {
            boost::asio::post(io, [this, revision, text = plan_text(revision, scene, plan, all),
                                   news = std::vector<Bounds>(all.begin(), all.end())] {
              if (revision >= first_revision) boxes = news;
              tell(PageText::plan, text);
            });
          },
          [this](std::shared_ptr<const ViewPicture> news) {
            boost::asio::post(io, [this, news = std::move(news)] {
              picture = news;
              packed.clear();
              for (PageConnection* page : pages) page->send(picture);
            });
          },
          [this](const ViewReport& report) {
            boost::asio::post(io, [this, text = report_text(report), revision = report.revision] {
              tell(PageText::report, text);
              if (revision == edits.revision() && picture->revision == revision)
                background->start(edits.scene(), picture);
            });
          },
          [this](std::uint32_t revision, const std::string& why) {
            boost::asio::post(io,
                              [this, text = failed_text(revision, why)] { tell(PageText::failed, text); });
          },
          [this](std::optional<std::size_t> shape) {
            boost::asio::post(io, [this, text = picked_text(shape)] {
              if (picking != nullptr) picking->answer(text);
            });
          }};
}

BackgroundEvents ViewServer::State::background_events() {
  return {[this](const TradeState& trade) {
            boost::asio::post(io, [this, text = trade_text(trade)] { tell(PageText::trade, text); });
          },
          [this](std::shared_ptr<const ViewPicture> news, const ReferenceState& state) {
            boost::asio::post(io, [this, news = std::move(news), state] {
              if (state.revision != edits.revision()) return;
              reference = news;
              tell(PageText::reference, reference_text(state));
              for (PageConnection* page : pages) page->send(reference);
            });
          },
          [this](const ChosenSettings& chosen) { boost::asio::post(io, [this, chosen] { take(chosen); }); },
          [this](std::uint32_t revision, const std::string& why) {
            boost::asio::post(io, [this, text = failed_text(revision, why)] {
              asked.target_error.reset();
              background->ask(asked);
              tell(PageText::failed, text);
            });
          }};
}

/// Every kTick during drawing; an idle view does not wake up.
void ViewServer::State::show_progress() {
  renderer->end_stale_work();
  shows_progress = renderer->is_drawing() || renders_file;
  const auto tell_news = [&](PageText kind, std::string text) {
    const SharedText& last = texts[kind];
    if (last == nullptr || *last != text) tell(kind, std::move(text));
  };
  tell_news(PageText::work, work_text(renderer->monitor()));
  tell_news(PageText::file, file_text(file_monitor, renders_file));
  if (!shows_progress) return;
  timer.expires_after(kTick);
  timer.async_wait([this](boost::beast::error_code) { show_progress(); });
}

}  // namespace opaline
