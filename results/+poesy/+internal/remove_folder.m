function remove_folder(folder)
% Removes a folder of tables that POESY.READ made for itself. Octave would ask whether it may, unless told.
  if exist(folder, 'dir') ~= 7
    return
  end
  if exist('OCTAVE_VERSION', 'builtin') ~= 0
    confirm_recursive_rmdir(false, 'local');
  end
  rmdir(folder, 's');
end
