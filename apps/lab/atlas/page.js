// The atlas: a slider a path, and keys for the entry that one looks at.
'use strict';
(() => {
  const kFlickerMs = 400;  // a picture; slower than three flashes a second, which some people cannot bear
  const kMostZoom = 8;
  const entries = [...document.querySelectorAll('.entry')].map(node => {
    const slider = node.querySelector('.path'), panes = node.querySelector('.panes');
    const entry = {node, slider, panes, zoom: 1, flicker: 0};
    if (window.burnish_live) node.querySelector('h2').append(' ', window.burnish_live.button(node.id));
    if (!slider) return entry;
    const steps = JSON.parse(node.querySelector('.steps').textContent), says = node.querySelector('.says');
    const show = () => {
      panes.style.setProperty('--at', slider.value);
      says.textContent = steps[slider.value];
      slider.setAttribute('aria-valuetext', steps[slider.value]);
    };
    slider.addEventListener('input', show);
    node.addEventListener('pointerdown', () => { current = entry; });
    node.addEventListener('focusin', () => { current = entry; });
    show();
    return entry;
  });
  let current = entries[0];

  function go(by) {
    const at = Math.max(0, Math.min(entries.length - 1, entries.indexOf(current) + by));
    current = entries[at];
    (current.slider || current.node).focus({preventScroll: true});
    current.node.scrollIntoView({block: 'start'});
  }

  function along(by) {
    if (!current.slider) return;
    current.slider.value = Number(current.slider.value) + by;
    current.slider.dispatchEvent(new Event('input'));
  }

  function zoom(factor) {
    if (!current.panes) return;
    current.zoom = Math.max(1, Math.min(kMostZoom, current.zoom * factor));
    current.panes.style.setProperty('--zoom', current.zoom);
  }

  function flicker() {
    if (!current.panes) return;
    const pane = current.panes.querySelector('[data-row="1"]');
    clearInterval(current.flicker);
    current.flicker = current.flicker ? 0 : setInterval(() => pane.classList.toggle('flickers'), kFlickerMs);
    if (!current.flicker) pane.classList.remove('flickers');
  }

  addEventListener('keydown', event => {
    if (event.ctrlKey || event.altKey || event.metaKey || !current) return;
    const arrows = event.target === current.slider;  // which moves by itself
    const act = {n: () => go(1), p: () => go(-1), f: flicker, '+': () => zoom(2), '=': () => zoom(2), '-': () => zoom(.5)}[event.key.toLowerCase()] ||
                (arrows ? null : {arrowleft: () => along(-1), arrowright: () => along(1)}[event.key.toLowerCase()]);
    if (!act) return;
    event.preventDefault();
    act();
  });
})();
