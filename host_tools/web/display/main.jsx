// SPDX-License-Identifier: MIT
// The display of a run.
import { render } from "preact";
import "../shared/theme.css";
render(<h1>Torolux</h1>, document.getElementById("page"));
