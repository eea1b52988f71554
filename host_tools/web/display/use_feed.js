// SPDX-License-Identifier: MIT
// A component is rendered again when the feed has changed, but not more often than it can bear.
import { useEffect, useState } from "preact/hooks";

/** interval: from one rendering to the next, at least [ms]. */
export function useFeed(feed, interval) {
  const [, render] = useState(0);
  useEffect(() => {
    let last = 0;
    let timer = 0;
    const now = () => {
      timer = 0;
      last = performance.now();
      render((count) => count + 1);
    };
    const end = feed.listen(() => {
      if (timer) return;
      const rest = last + interval - performance.now();
      if (rest <= 0) now();
      else timer = setTimeout(now, rest);
    });
    now();
    return () => {
      end();
      clearTimeout(timer);
    };
  }, [feed, interval]);
}
