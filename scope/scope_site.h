// What hydro-scope serves: the page, its web sockets, and uploaded and downloaded files
// (docs/developers/scope_protocol.md).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scope/diagnose_jobs.h"
#include "scope/live_conversation.h"
#include "scope/page_files.h"
#include "scope/side_work.h"
#include "scope/wire/site.h"

namespace hydro::scope {

class ScopeSite : public Site {
 public:
  // `upload_bytes` is the largest size of an uploaded log.
  ScopeSite(PageFiles page, LiveContext context, SideWork* work, DiagnoseJobs* jobs, int64_t upload_bytes);

  bool IsPublic(const std::string& path) const override;
  int64_t BodyLimit(const Request& head) const override;
  std::string BodyFile(const Request& head) override;
  void Answer(Request request, std::function<void(Response)> reply) override;
  std::unique_ptr<Conversation> Converse(const std::string& path, const std::vector<std::string>& offered,
                                         std::string* chosen) override;

  // More facts for /api/status, as "name": value pairs of JSON.
  std::function<std::string()> more_status;

 private:
  using Reply = std::function<void(Response)>;
  std::string Status() const;
  void Open(const Request& request, const Reply& reply);
  void Close(const Request& request, const Reply& reply);
  void Cut(const Request& request, const Reply& reply);
  void Diagnose(const Request& request, const Reply& reply);

  PageFiles page_;
  LiveContext context_;
  SideWork& work_;
  DiagnoseJobs& jobs_;
  int64_t upload_bytes_;
};

}  // namespace hydro::scope
