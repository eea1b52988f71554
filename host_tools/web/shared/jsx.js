// SPDX-License-Identifier: MIT
// What elements in .jsx files are made by; bundle.sh brings it into each.
export { h, Fragment } from "preact";
