const slide = (after, steps, show) => {
  const box = document.createElement('p'), play = document.createElement('button'), bar = document.createElement('input');
  box.className = 'slide';
  play.type = 'button';
  play.textContent = 'play';
  bar.type = 'range';
  bar.max = steps;
  bar.value = steps;
  bar.setAttribute('aria-label', 'time');
  let clock = 0;
  const stop = () => { clearInterval(clock); clock = 0; play.textContent = 'play'; };
  const next = () => { bar.value = +bar.value < steps ? +bar.value + 1 : 0; show(+bar.value); };
  bar.oninput = () => { stop(); show(+bar.value); };
  play.onclick = () => {
    if (clock) return stop();
    clock = setInterval(next, 120);
    play.textContent = 'stop';
  };
  box.append(play, bar);
  after.after(box);
  show(steps);
};
for (const frames of document.querySelectorAll('.frames')) {
  const all = [...frames.children];
  frames.classList.add('one');
  slide(frames, all.length - 1, i => all.forEach((frame, k) => { frame.hidden = k !== i; }));
}
for (const moving of document.querySelectorAll('svg.moving')) {
  const end = moving.dataset.seconds;
  slide(moving, 100, i => { moving.pauseAnimations(); moving.setCurrentTime(end * Math.min(i, 99.9) / 100); });
}
