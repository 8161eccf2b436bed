// Loads the driver's view.

import {byId, make} from "./dom.js";

const VIEW_FILE = "./driver_view.js";  // this file contains three.js, and is loaded separately

/**
 * Loads the view into its canvas. The view has the same colours in every scheme, so that all people
 * see the same road.
 * @return the view; null if it cannot be shown; the page then shows the reason
 */
export async function loadView() {
  try {
    const {DriverView} = await import(VIEW_FILE);
    return new DriverView(byId("driver-view"));
  } catch (problem) {
    byId("picture").append(make("p", {class: "no-view"},
      `The driver’s view needs WebGL, which this browser does not offer. (${problem.message})`));
    return null;
  }
}
