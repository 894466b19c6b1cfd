// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

/// What the Qt application knows that this process is, as ParaView's is; false where it is none.
///@{
bool IsModalDialogOpen();
bool IsMouseButtonDown();
///@}

} // namespace inr
