% The law over a recorded run, and what was commanded there, by exchange of files:
%   hydro-log export run.lcmlog -o run.csv; octave check_law.m run.csv
% In MATLAB: file = 'run.csv'; check_law
if ~exist('file', 'var'), words = argv(); file = words{1}; end
addpath(fileparts(mfilename('fullpath')));
every = 5;  % ticks from one answer to the next: sample_interval_s * rate_hz

opened = fopen(file);
names = strsplit(fgetl(opened), ',');
fclose(opened);
data = dlmread(file, ',', 1, 0);
column = @(name) data(:, strcmp(names, name));
tick = column('tick');
speed = column('arm_speed_rad_s');
angle = column('arm_angle_rad');
in_force = column('pressure_ref_psi');  % a command acts from the tick after its own, until that after the next one's

answered = 0; same = 0; worst = 0;
for row = find(mod(tick, every) == 0)'
  newest = find(tick > tick(row) & tick <= tick(row) + every, 1, 'last');
  if isempty(newest), continue; end  % the run's last state
  answered = answered + 1;
  difference = abs(pd_law(angle(row), speed(row)) - in_force(newest));
  if difference == 0, same = same + 1; else, worst = max(worst, difference); end
end
if same == answered && answered > 0
  fprintf('identical: %d commands\n', answered);
else
  fprintf('%d of %d commands differ, by up to %g psi\n', answered - same, answered, worst);
  exit(1);
end
