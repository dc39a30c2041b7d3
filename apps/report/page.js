// Pages of charts and of comparisons: pictures beside the points of charts, and walls of pictures that zoom and flicker together.
'use strict';
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const tip = document.getElementById('tip');
  const picture = text => text[0] === '#' ? document.querySelector(text).src : text;  // one of the page's own, by its id
  const kFlickerMs = 400;  // a picture; slower than three flashes a second, which some people cannot bear
  const kMostZoom = 16;

  function element(name, attributes, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes || {}))
      if (key in made && key !== 'style' && key !== 'list') made[key] = value; else made.setAttribute(key, value);
    made.append(...children);
    return made;
  }

  // --- pictures of points

  function showTip(point) {
    const row = data.rows[point.dataset.row];
    for (const other of document.querySelectorAll('.point.shown')) other.classList.remove('shown');
    point.classList.add('shown');
    tip.replaceChildren(element('img', {src: picture(row.picture), alt: ''}), row.text);
    tip.dataset.row = point.dataset.row;
    tip.hidden = false;
    placeTip(point);
  }

  function placeTip(point) {
    const at = point.getBoundingClientRect(), box = tip.getBoundingClientRect();
    const left = at.right + 12 + box.width < innerWidth ? at.right + 12 : at.left - 12 - box.width;
    tip.style.left = Math.max(4, Math.min(left, innerWidth - box.width - 4)) + 'px';
    tip.style.top = Math.max(4, Math.min(at.top - box.height / 2, innerHeight - box.height - 4)) + 'px';
  }

  function hideTip() {
    tip.hidden = true;
    for (const point of document.querySelectorAll('.point.shown')) point.classList.remove('shown');
  }

  // One stop of the Tab key a chart; arrow keys go through its points from left to right, or over a map's cells.
  function nextPoint(points, from, key) {
    const centre = point => { const box = point.querySelector('.mark').getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; };
    const [x, y] = centre(from), map = from.classList.contains('cell');
    if (key === 'Home' || key === 'End') {
      const ordered = map ? points : [...points].sort((a, b) => centre(a)[0] - centre(b)[0]);
      return ordered[key === 'Home' ? 0 : points.length - 1];
    }
    const ahead = points.map(point => ({point, dx: centre(point)[0] - x, dy: centre(point)[1] - y})).filter(({point, dx, dy}) => point !== from &&
      (key === 'ArrowRight' ? dx > 0 || (dx === 0 && dy > 0 && !map) : key === 'ArrowLeft' ? dx < 0 || (dx === 0 && dy < 0 && !map) : key === 'ArrowDown' ? dy > 0 : dy < 0));
    const across = key === 'ArrowLeft' || key === 'ArrowRight';
    const cost = ({dx, dy}) => map ? (across ? Math.abs(dx) + 100 * Math.abs(dy) : Math.abs(dy) + 100 * Math.abs(dx)) : across ? Math.abs(dx) : Math.abs(dy);
    return ahead.sort((a, b) => cost(a) - cost(b)).map(a => a.point)[0];
  }

  function prepareChart(chart) {
    const points = [...chart.querySelectorAll('.point[data-row]')];
    for (const title of chart.querySelectorAll('title')) title.remove();  // the page has its own
    points.forEach((point, i) => {
      point.setAttribute('tabindex', i ? -1 : 0);
      point.addEventListener('mouseenter', () => showTip(point));
      point.addEventListener('mouseleave', hideTip);
      point.addEventListener('focus', () => showTip(point));
      point.addEventListener('blur', hideTip);
      point.addEventListener('click', () => point.focus());
    });
    chart.addEventListener('keydown', event => {
      if (event.key === 'Escape') return hideTip();
      if (event.key === 'Enter') return showInWall(event.target.dataset.row);
      if (!/^(Arrow(Left|Right|Up|Down)|Home|End)$/.test(event.key)) return;
      event.preventDefault();
      const next = nextPoint(points, event.target, event.key);
      if (!next) return;
      event.target.setAttribute('tabindex', -1);
      next.setAttribute('tabindex', 0);
      next.focus();
    });
  }

  // --- walls

  const pickers = new Map();  // row to the list that can choose it and the tile that shows it

  function showInWall(key) {
    const {list, tile} = pickers.get(key) || {};
    if (!list) return;
    list.value = key;
    list.dispatchEvent(new Event('change'));
    tile.scrollIntoView({block: 'center'});
  }

  function makeTile(wall, place, keys) {
    const first = data.rows[keys[0]];
    const image = (css, alt) => element('img', {className: css, alt, draggable: false});
    const technique = image('picture', ''), error = image('error', '');
    const reference = element('img', {className: 'reference', alt: '', draggable: false});
    const view = element('div', {className: 'view', tabIndex: 0, role: 'img', style: `aspect-ratio: ${place.width || data.width} / ${place.height || data.height}`},
                         reference, element('div', {className: 'clip technique'}, technique), error);
    const list = element('select', {}, ...keys.map(key => element('option', {value: key}, data.rows[key].setting)));
    list.setAttribute('aria-label', 'setting of ' + first.technique);
    const figures = element('span', {className: 'figures'}), live = element('span');
    const draw = () => {
      if (window.burnish_live) live.replaceChildren(window.burnish_live.button(data.rows[list.value].live || list.value));
      const row = data.rows[list.value], exposed = wall.exposure >= 0 && row.exposures;
      technique.src = picture(exposed ? row.exposures[wall.exposure] : row.picture);
      reference.src = picture(exposed ? place.exposures[wall.exposure].reference : place.reference);
      error.src = picture(row.error);
      figures.textContent = row.figures;
      view.setAttribute('aria-label', `${row.text}. Arrow keys move, plus and minus zoom, F flickers.`);
    };
    list.addEventListener('change', draw);
    wall.draws.push(draw);
    list.value = place.shown.find(key => keys.includes(key)) || keys[0];
    list.dispatchEvent(new Event('change'));
    wall.panWith(view);
    const tile = element('figure', {className: 'tile'}, view,
                         element('figcaption', {}, element('strong', {}, first.technique), keys.length > 1 ? list : '', figures, live));
    keys.forEach(key => pickers.set(key, {list, tile}));
    return tile;
  }

  class Wall {
    constructor(place, index) {
      this.zoom = 1, this.x = 0, this.y = 0;  // x, y: of the picture's corner, in parts of the view
      const modes = [['split', 'Side by side'], ['technique', data.subject], ['reference', data.other || 'Reference'], ['error', 'Error map']];
      this.radios = modes.map(([value]) => element('input', {type: 'radio', name: 'mode-' + index, value, checked: value === 'split'}));
      this.split = element('input', {type: 'range', min: 0, max: 100, step: 1, value: 50, className: 'split'});
      this.zoomer = element('input', {type: 'range', min: 0, max: Math.log2(kMostZoom), step: 0.1, value: 0, className: 'zoom'});
      this.button = element('button', {type: 'button', className: 'flicker'}, 'Flicker');
      const reset = element('button', {type: 'button'}, 'Whole picture');
      this.button.setAttribute('aria-pressed', 'false');
      this.tiles = element('div', {className: 'tiles'});
      this.draws = [];      // functions, one a tile: each shows its pictures at the exposure
      this.exposure = -1;  // index of the place's exposures; -1: they have none
      const exposer = place.exposures ? this.makeExposer(place.exposures) : '';
      const techniques = [...new Set(place.rows.map(key => data.rows[key].technique))];
      this.tiles.append(...techniques.map(name => makeTile(this, place, place.rows.filter(key => data.rows[key].technique === name))));
      const legend = element('legend', {}, 'Show');
      const controls = element('div', {className: 'controls'},
        element('fieldset', {}, legend, ...modes.map(([, text], i) => element('label', {}, this.radios[i], text))),
        element('label', {}, (data.other || 'Reference') + ' | ' + data.subject.toLowerCase(), this.split), this.button, element('label', {}, 'Zoom', this.zoomer), exposer, reset);
      this.node = element('div', {}, controls, this.tiles);
      this.radios.forEach(radio => radio.addEventListener('change', () => this.setMode(radio.value)));
      this.split.addEventListener('input', () => this.tiles.style.setProperty('--split', this.split.value + '%'));
      this.zoomer.addEventListener('input', () => this.zoomTo(2 ** this.zoomer.value, 0.5, 0.5));
      this.button.addEventListener('click', () => this.flicker());
      reset.addEventListener('click', () => this.zoomTo(1, 0, 0));
      this.tiles.addEventListener('keydown', event => this.key(event));
      this.setMode('split');
    }
    makeExposer(exposures) {  // a slider over pictures of the same values at several exposures
      const slider = element('input', {type: 'range', min: 0, max: exposures.length - 1, step: 1, className: 'exposure'}), text = element('output');
      const choose = index => {
        const stops = exposures[index].stops, words = `${stops > 0 ? '+' : ''}${stops} stops`;
        this.exposure = index;
        text.textContent = words;
        slider.setAttribute('aria-valuetext', words);
        this.draws.forEach(draw => draw());
      };
      slider.value = exposures.findIndex(({stops}) => stops === 0);
      slider.addEventListener('input', () => choose(Number(slider.value)));
      choose(Number(slider.value));
      return element('label', {}, 'Exposure', slider, text);
    }
    setMode(mode) {
      if (this.timer) this.flicker();
      this.tiles.dataset.mode = mode;
      this.radios.forEach(radio => { radio.checked = radio.value === mode; });
      this.split.disabled = mode !== 'split';
    }
    flicker() {
      const on = !this.timer;
      this.button.setAttribute('aria-pressed', String(on));
      if (!on) {
        clearInterval(this.timer);
        this.timer = 0;
        return this.setMode('technique');
      }
      const flip = () => { this.tiles.dataset.mode = this.tiles.dataset.mode === 'technique' ? 'reference' : 'technique'; };
      flip();
      this.timer = setInterval(flip, kFlickerMs);
    }
    zoomTo(zoom, cx, cy) {  // the point (cx, cy) of the view stays where it is
      zoom = Math.max(1, Math.min(kMostZoom, zoom));
      this.moveTo(cx - (cx - this.x) * zoom / this.zoom, cy - (cy - this.y) * zoom / this.zoom, zoom);
    }
    moveTo(x, y, zoom = this.zoom) {
      this.zoom = zoom;
      this.x = Math.max(1 - zoom, Math.min(0, x));
      this.y = Math.max(1 - zoom, Math.min(0, y));
      this.zoomer.value = Math.log2(zoom);
      this.tiles.classList.toggle('zoomed', zoom > 1);
      const style = this.tiles.style;
      style.setProperty('--zoom', zoom), style.setProperty('--x', 100 * this.x + '%'), style.setProperty('--y', 100 * this.y + '%');
    }
    key(event) {
      if (event.target.localName === 'select' || event.ctrlKey || event.altKey || event.metaKey) return;
      const step = {ArrowLeft: [.1, 0], ArrowRight: [-.1, 0], ArrowUp: [0, .1], ArrowDown: [0, -.1]}[event.key];
      const mode = {s: 'split', t: 'technique', r: 'reference', e: 'error'}[event.key.toLowerCase()];
      if (step && this.zoom > 1) this.moveTo(this.x + step[0], this.y + step[1]);
      else if (event.key === '+' || event.key === '=') this.zoomTo(this.zoom * 2, .5, .5);
      else if (event.key === '-') this.zoomTo(this.zoom / 2, .5, .5);
      else if (mode) this.setMode(mode);
      else if (event.key.toLowerCase() === 'f') this.flicker();
      else return;
      event.preventDefault();
    }
    panWith(view) {
      const part = (event, box) => [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
      let last = null;
      view.addEventListener('pointerdown', event => { last = part(event, view.getBoundingClientRect()); view.setPointerCapture(event.pointerId); });
      view.addEventListener('pointermove', event => {
        if (!last || this.zoom === 1) return;
        const now = part(event, view.getBoundingClientRect());
        this.moveTo(this.x + now[0] - last[0], this.y + now[1] - last[1]);
        last = now;
      });
      for (const name of ['pointerup', 'pointercancel']) view.addEventListener(name, () => { last = null; });
      view.addEventListener('dblclick', event => this.zoomTo(this.zoom > 1 ? 1 : 4, ...part(event, view.getBoundingClientRect())));
      view.addEventListener('wheel', event => {
        if (!event.ctrlKey) return;  // or the page could not be scrolled past
        event.preventDefault();
        this.zoomTo(this.zoom * 2 ** (-event.deltaY / 200), ...part(event, view.getBoundingClientRect()));
      }, {passive: false});
    }
  }

  // A place's wall is made when it is first looked at: pictures of hidden places are not decoded.
  function showPlace(node) {
    const index = Number(node.dataset.place), box = node.querySelector('.wall');
    if (!box.firstChild) box.append(new Wall(data.places[index], index).node);
    node.hidden = false;
  }

  document.querySelectorAll('svg.chart').forEach(prepareChart);
  for (const pair of document.querySelectorAll('.pair')) {
    const places = [...pair.querySelectorAll('.place')], list = pair.querySelector('.cells');
    const choose = i => places.forEach((place, k) => { if (k === i) showPlace(place); else place.hidden = true; });
    if (list) list.addEventListener('change', () => choose(list.selectedIndex));
    choose(list ? list.selectedIndex : 0);
  }
  // Going to a point by key may scroll the page under its picture.
  addEventListener('scroll', () => { const point = document.querySelector('.point.shown'); if (point) placeTip(point); }, {passive: true});
})();
