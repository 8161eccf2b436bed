// Loads the driver's view, and shows it in the light or dark colours of the system.

import {byId, darkScheme, make} from "./dom.js";

const VIEW_FILE = "./driver_view.js";  // this file contains three.js, and is loaded separately

/** Gives the view the light or dark colours of the system. */
export function setScheme(view) {
  view.setScheme(darkScheme.matches ? "dark" : "light");
}

/**
 * Loads the view into its canvas, in light colours.
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
